// Writes what `explain` knows of a case as JSON.
#include "cli/explain_json.h"

#include <nlohmann/json.hpp>

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

Json model(const scene::Forecast& rung) {
  Json object{{"model", scenario::rung(rung.model).word}};
  if (rung.cannot.empty())
    object.update({{"error", rung.error}, {"seconds", rung.seconds}});
  else
    object["cannot"] = rung.cannot;
  return object;
}

}  // namespace

std::string explain_json(const std::string& scenario, const scene::Scene& scene,
                         const run::Expected& expected) {
  Json object{{"event", "explanation"},
              {"scenario", scenario},
              {"case", scene.name},
              {"model", scenario::rung(scene.scenario.solver.model).word},
              {"named_by_scenario", scene.choice.given},
              {"error", nullptr},
              {"tolerance", scene.scenario.solver.tolerance},
              {"sentences",
               {{"model", expected.answer.model},
                {"error", expected.answer.error},
                {"left_out", expected.answer.left_out}}},
              {"left_out", Json::array()},
              {"criteria", Json::array()},
              {"models", Json::array()}};
  if (expected.answer.stated_error) object["error"] = *expected.answer.stated_error;
  for (const run::LeftOut& one : expected.left_out)
    object["left_out"].push_back(
        {{"effect", one.what}, {"change", one.change}, {"text", one.when}, {"remedy", one.remedy}});
  for (const scene::Question& one : scene.choice.questions)
    object["criteria"].push_back({{"topic", one.asked},
                                  {"measure", one.measure},
                                  {"number", one.number},
                                  {"limit", one.threshold},
                                  {"answer", one.answer}});
  for (const scene::Forecast& rung : scene.choice.rungs) object["models"].push_back(model(rung));
  if (scene.specimen) {
    object["mesh"] = {{"nodes", scene.specimen->network.nodes()},
                      {"tetrahedra", scene.specimen->mesh.tetrahedra.size()},
                      {"springs", scene.specimen->network.springs()}};
    if (expected.mesh_error) object["mesh"]["error"] = *expected.mesh_error;
  }
  return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palpate::cli
