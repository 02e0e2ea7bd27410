// The only file that includes OpenMesh. OpenMesh's half-edge mesh silently drops faces that it
// cannot connect; therefore the readers fill plain lists here.
#include "meshing/openmesh_library.h"

#include <OpenMesh/Core/IO/IOInstances.hh>
#include <OpenMesh/Core/IO/IOManager.hh>
#include <locale>
#include <sstream>

namespace palpate::meshing::openmesh_library {
namespace {

namespace om = OpenMesh;

class Lists final : public om::IO::BaseImporter {
 public:
  Polygons polygons;

  om::VertexHandle add_vertex(const om::Vec3f& point) override {
    polygons.vertices.emplace_back(point[0], point[1], point[2]);
    return om::VertexHandle(static_cast<int>(polygons.vertices.size()) - 1);
  }
  om::VertexHandle add_vertex() override { return add_vertex(om::Vec3f(0.0F, 0.0F, 0.0F)); }
  void set_point(om::VertexHandle vertex, const om::Vec3f& point) override {
    polygons.vertices[as_index(vertex.idx())] = {point[0], point[1], point[2]};
  }
  om::FaceHandle add_face(const VHandles& vertices) override {
    std::vector<int>& corners = polygons.corners.emplace_back();
    for (const om::VertexHandle vertex : vertices) corners.push_back(vertex.idx());
    return om::FaceHandle(static_cast<int>(polygons.corners.size()) - 1);
  }
  [[nodiscard]] size_t n_vertices() const override { return polygons.vertices.size(); }
  [[nodiscard]] size_t n_faces() const override { return polygons.corners.size(); }
  [[nodiscard]] size_t n_edges() const override { return 0; }

  // Normals, colours, texture and connectivity are ignored.
  om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override {
    return om::HalfedgeHandle();
  }
  om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
  void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                          const std::vector<om::Vec2f>&) override {}
  void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                          const std::vector<om::Vec3f>&) override {}
  void set_face_texindex(om::FaceHandle, int) override {}
  void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
  void set_normal(om::VertexHandle, const om::Vec3f&) override {}
  void set_normal(om::VertexHandle, const om::Vec3d&) override {}
  void set_color(om::VertexHandle, const om::Vec3uc&) override {}
  void set_color(om::VertexHandle, const om::Vec4uc&) override {}
  void set_color(om::VertexHandle, const om::Vec3f&) override {}
  void set_color(om::VertexHandle, const om::Vec4f&) override {}
  void set_texcoord(om::VertexHandle, const om::Vec2f&) override {}
  void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
  void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
  void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
  void set_texcoord(om::VertexHandle, const om::Vec3f&) override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
  void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec3f&) override {}
  void set_color(om::EdgeHandle, const om::Vec4f&) override {}
  void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_normal(om::FaceHandle, const om::Vec3f&) override {}
  void set_normal(om::FaceHandle, const om::Vec3d&) override {}
  void set_color(om::FaceHandle, const om::Vec3uc&) override {}
  void set_color(om::FaceHandle, const om::Vec4uc&) override {}
  void set_color(om::FaceHandle, const om::Vec3f&) override {}
  void set_color(om::FaceHandle, const om::Vec4f&) override {}
  void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}
};

}  // namespace

Polygons run(const std::string& content, const std::string& format, bool binary) {
  std::locale::global(std::locale::classic());  // numbers with a decimal point
  std::istringstream stream(content, std::ios::in | std::ios::binary);
  om::IO::Options options;
  if (binary) options += om::IO::Options::Binary;
  Lists lists;
  lists.polygons.good = om::IO::IOManager().read(stream, format, lists, options);
  return std::move(lists.polygons);
}

}  // namespace palpate::meshing::openmesh_library
