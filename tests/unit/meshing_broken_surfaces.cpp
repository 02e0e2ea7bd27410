// Files that are no surface, or half of one: each gets its sentence, and nothing is printed.
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <random>
#include <utility>
#include <vector>

#include "base/files.h"
#include "broken_surface.h"

namespace palpate::meshing {
namespace {

// This thread, and the children that it starts, without the capabilities of root (capset(2)), by
// which root reads any file.
class NoPrivileges {
 public:
  NoPrivileges() {
    EXPECT_EQ(::syscall(SYS_capget, &header_, before_.data()), 0);
    auto none = before_;
    for (auto& part : none) part.effective = 0;
    EXPECT_EQ(::syscall(SYS_capset, &header_, none.data()), 0);
  }
  ~NoPrivileges() { ::syscall(SYS_capset, &header_, before_.data()); }
  NoPrivileges(const NoPrivileges&) = delete;
  NoPrivileges& operator=(const NoPrivileges&) = delete;

 private:
  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> before_{};
};

TEST_F(BrokenSurfaces, whole_ones_are_sound) {
  EXPECT_EQ(complaint("a.obj", good_obj), "sound");
  EXPECT_EQ(complaint("a.off", good_off), "sound");
  EXPECT_EQ(complaint("a.ply", good_ply), "sound");
  EXPECT_EQ(complaint("a.stl", good_stl), "sound");
  EXPECT_EQ(complaint("b.ply", binary_ply()), "sound");
  EXPECT_EQ(complaint("b.stl", binary_stl()), "sound");
}

TEST_F(BrokenSurfaces, files_that_cannot_be_read) {
  EXPECT_EQ(verdict("none.stl"),
            "input: none.stl: cannot be read: No such file or directory; check the path");
  EXPECT_EQ(complaint("a.step", good_obj),
            "input: a.step: a surface wants the ending `.stl`, `.obj`, `.ply`, `.off`, `.vtp`, "
            "`.vtu`, `.vtk`, `.msh`, `.inp` or `.mesh`; export it as one of these");
  EXPECT_TRUE(complaint("stl", good_stl).starts_with("input: stl: a surface wants the ending"));
  for (const char* name : {"folder.stl", "folder.obj", "folder.ply", "folder.off"}) {
    std::filesystem::create_directory(path(name));
    EXPECT_EQ(verdict(name),
              std::string("input: ") + name + ": is not a file; give the path of a file");
  }
  write_atomically(path("locked.obj"), good_obj);
  ::chmod(path("locked.obj").c_str(), 0);
  const NoPrivileges none;
  EXPECT_EQ(verdict("locked.obj"),
            "input: locked.obj: cannot be read: Permission denied; check its permissions");
}

TEST_F(BrokenSurfaces, empty_files) {
  EXPECT_EQ(complaint("a.obj", ""), "input: a.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("b.obj", "# nothing\n"),
            "input: b.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("a.off", ""),
            "input: a.off: the file wants to begin with `OFF`; export it again, or give it the "
            "ending of its real format");
  EXPECT_EQ(
      complaint("a.ply", ""),
      "input: a.ply: does not begin with `ply`; export it again, or give it the ending of its "
      "real format");
  EXPECT_EQ(complaint("a.stl", ""),
            "input: a.stl: is neither an ASCII STL, which begins with `solid`, nor a binary one, "
            "which would have 84 bytes for its 0 facets, not 0; it is cut short or of another "
            "format: export it again");
}

TEST_F(BrokenSurfaces, no_faces) {
  const std::string want = "holds no faces; export the surface again";
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "input: a.obj: " + want);
  EXPECT_EQ(complaint("a.off", "OFF\n1 0 0\n0 0 0\n"), "input: a.off: " + want);
  EXPECT_EQ(complaint("a.stl", "solid\nendsolid\n"), "input: a.stl: " + want);
  EXPECT_EQ(complaint("b.stl", std::string(84, '\0')), "input: b.stl: " + want);
  EXPECT_EQ(
      complaint("a.ply", with(with(with(good_ply, "face 4", "face 0"), "3 0 2 1\n3 0 1 3\n", ""),
                              "3 0 3 2\n3 1 2 3\n", "")),
      "input: a.ply: " + want);
}

TEST_F(BrokenSurfaces, another_format_under_this_ending) {
  EXPECT_EQ(
      complaint("a.obj", binary_stl()),
      "input: a.obj: is not a text file in OBJ format; export it again, or give it the ending "
      "of its real format");
  EXPECT_EQ(complaint("b.obj", good_off), "input: b.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("a.off", good_obj),
            "input: a.off:1: the file wants to begin with `OFF`; export it again, or give it the "
            "ending of its real format");
  EXPECT_EQ(
      complaint("a.ply", good_stl),
      "input: a.ply: does not begin with `ply`; export it again, or give it the ending of its "
      "real format");
  EXPECT_EQ(complaint("a.stl", good_obj),
            "input: a.stl:1: the line wants `solid`, got `v`; export the "
            "file again");
}

TEST_F(BrokenSurfaces, garbage) {
  std::mt19937 random(7);  // its sequence is fixed by the standard
  std::string noise(5000, '\0');
  for (char& letter : noise) letter = static_cast<char>(random() & 255U);
  for (const std::string ending : {"obj", "off", "ply", "stl"}) {
    for (const std::string& content :
         {noise, std::string(4096, '\0'), std::string(100000, 'x'), "\xff\xfe" + noise,
          "ply\nformat ascii 1.0\n" + noise, "OFF\n" + noise, "solid \n" + noise, "v 1 " + noise}) {
      const std::string got = complaint("g." + ending, content);
      EXPECT_TRUE(got.starts_with("input: g." + ending + ":")) << got;
      EXPECT_LT(got.size(), 400u) << got;
    }
  }
  EXPECT_EQ(
      complaint("z.off", std::string(4096, '\0')),
      "input: z.off: is not a text file in OFF format; export it again, or give it the ending "
      "of its real format");
}

// Wherever a file ends, it is refused; text may lack its last line end, and an OBJ that ends
// between two lines, or in a number that is still a vertex, is found by its holes.
TEST_F(BrokenSurfaces, cut_short_anywhere) {
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"a.obj", good_obj},
           {"a.off", good_off},
           {"a.ply", good_ply},
           {"a.stl", good_stl.substr(0, good_stl.size() - 5)},
           {"b.ply", binary_ply()},
           {"b.stl", binary_stl()}})
    for (std::size_t size = 0; size + 1 < content.size(); ++size) {
      const std::string got = complaint(name, content.substr(0, size));
      ASSERT_TRUE(got.starts_with("input: ") || got.starts_with("mesh: "))
          << name << " of " << size << " bytes: " << got;
      ASSERT_GT(got.size(), 40u) << got;
    }
}

TEST_F(BrokenSurfaces, says_where_it_is_cut_short) {
  EXPECT_EQ(complaint("a.obj", good_obj.substr(0, good_obj.size() - 3)),
            "input: a.obj:8: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("b.obj", "v 0 0 0\nv 1 0"),
            "input: b.obj:2: a vertex wants three coordinates, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(
      complaint("a.off", good_off.substr(0, good_off.size() - 16)),
      "input: a.off:2: the header counts 4 vertices and 4 faces, but 6 lines follow; mend the "
      "counts, or export the file again if it is cut short");
  EXPECT_EQ(complaint("b.off", "OFF\n"),
            "input: b.off:1: the file ends after `OFF`; it is cut short: export it again");
  EXPECT_EQ(complaint("a.ply", good_ply.substr(0, good_ply.size() - 9)),
            "input: a.ply:16: the file ends after 3 of 4 lines of element `face`; it is cut short: "
            "export it again");
  EXPECT_EQ(
      complaint("d.ply", good_ply.substr(0, good_ply.size() - 2)),
      "input: d.ply:17: a face wants three corners or more, got 2; the file may be cut short: "
      "export it again");
  EXPECT_EQ(complaint("a.stl", good_stl.substr(0, good_stl.size() - 13)),
            "input: a.stl:29: the file ends before `endsolid`, in or after facet 4; it is cut "
            "short: export it again");
  EXPECT_EQ(complaint("b.ply", binary_ply().substr(0, binary_ply().size() - 1)),
            "input: b.ply: the file ends in number 3 of 4 of element `face`; it is cut short: "
            "export it again");
  EXPECT_EQ(complaint("c.ply", binary_ply().substr(0, 100)),
            "input: c.ply: ends before `end_header`; it is cut short: export it again");
  std::string version = good_ply;
  version.replace(version.find("1.0"), 3, ".");
  EXPECT_EQ(complaint("d.ply", version),
            "input: d.ply: line 2 of its header is not understood; export it again");
  EXPECT_EQ(complaint("b.stl", binary_stl().substr(0, 200)),
            "input: b.stl: is neither an ASCII STL, which begins with `solid`, nor a binary one, "
            "which would have 284 bytes for its 4 facets, not 200; it is cut short or of another "
            "format: export it again");
}

TEST_F(BrokenSurfaces, counts_that_lie) {
  for (const std::uint32_t count : {0U, 3U, 5U, 4000000000U})
    EXPECT_NE(
        complaint("a.stl", binary_stl(count)).find(std::to_string(count) + " facets, not 284"),
        std::string::npos);
  for (const std::string counts : {"4 3", "4 5", "5 4", "3 4", "2000000000 4"}) {
    std::string told = counts;
    told.replace(told.find(' '), 1, " vertices and ");
    EXPECT_EQ(complaint("a.off", with(good_off, "4 4 6", counts + " 6")),
              "input: a.off:2: the header counts " + told +
                  " faces, but 8 lines follow; mend the counts, or export the file again if it is "
                  "cut short");
  }
  EXPECT_EQ(complaint("b.off", with(good_off, "4 4 6", "3 5 6")),
            "input: b.off:6: a face wants three corners or more, got 0; mend the line, or the "
            "counts of the header if this is a vertex");
  EXPECT_EQ(complaint("d.off", with(good_off, "4 4 6", "-4 4 6")),
            "input: d.off:2: the number of vertices is missing or negative; after `OFF` write the "
            "numbers of vertices, faces and edges");
  EXPECT_EQ(complaint("a.ply", with(good_ply, "face 4", "face 3")),
            "input: a.ply:17: the header counts 3 faces, but another line follows; mend the count");
  EXPECT_EQ(complaint("b.ply", with(good_ply, "face 4", "face 1000000000")),
            "input: b.ply:17: the file ends after 4 of 1000000000 lines of element `face`; it is "
            "cut short: export it again");
  EXPECT_EQ(
      complaint("c.ply", with(binary_ply(), "face 4", "face 3")),
      "input: c.ply: 13 bytes follow the last of 3 faces; the count is wrong: export it again");
  EXPECT_EQ(complaint("d.ply", with(binary_ply(), "vertex 4", "vertex 900000000")),
            "input: d.ply: the file ends in number 8 of 900000000 of element `vertex`; it is cut "
            "short: export it again");
  EXPECT_EQ(complaint("e.ply", with(good_ply, "vertex 4", "vertex 4e99")),
            "input: e.ply: line 3 of its header wants a count from 0 to 1e9; export it again");
}

}  // namespace
}  // namespace palpate::meshing
