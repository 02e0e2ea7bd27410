// plan.json as JSON text. The text is hashed, so that its keys are written in a fixed order.
#include "sweep/plan_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"

namespace palpate::sweep {

using Json = nlohmann::ordered_json;

std::string plan_text(const PlanFile& file) {
  Json json;
  json["palpate_sweep"] = 1;  // version of the file format
  json["program"] = file.program;
  json["scenario"] = file.name;
  json["settings"] = file.settings;
  json["curves"] = file.curves;
  json["cases"] = file.cases;
  if (file.model) json["model"] = scenario::traits(*file.model).word;  // of `auto`, for all cases
  json["plan_csv_sha256"] = file.csv_hash;
  json["inputs"] = Json::array();
  for (const auto& [name, hash] : file.inputs)
    json["inputs"].push_back({{"name", name}, {"sha256", hash}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

PlanFile read_plan_file(const std::string& text, const std::string& path) {
  PlanFile file;
  try {
    const Json json = Json::parse(text);
    if (json.at("palpate_sweep") != 1) throw std::runtime_error("another form");
    file.program = json.at("program");
    file.name = json.at("scenario");
    file.settings = json.at("settings").get<std::vector<std::string>>();
    file.curves = json.at("curves");
    const Json& cases = json.at("cases");
    if (!cases.is_number_unsigned()) throw std::runtime_error("no number of cases");
    file.cases = cases;
    if (json.contains("model")) {
      const auto named = [&](const scenario::ModelTraits& traits) {
        return json["model"] == traits.word;
      };
      const auto* traits =
          std::find_if(scenario::model_table.begin(), scenario::model_table.end(), named);
      if (traits == scenario::model_table.end()) throw std::runtime_error("no model");
      file.model = traits->of;
    }
    file.csv_hash = json.at("plan_csv_sha256");
    for (const Json& input : json.at("inputs"))
      file.inputs.emplace_back(input.at("name"), input.at("sha256"));
  } catch (const std::exception&) {
    throw InputError({path, 0, 0},
                     "is damaged, or made by another version; put it back, or plan anew");
  }
  return file;
}

std::string differences(const PlanFile& a, const PlanFile& b) {
  std::vector<std::string> names;
  if (a.program != b.program) names.emplace_back("version of the program");
  if (a.curves != b.curves) names.emplace_back("`--curves`");
  if (a.cases != b.cases)
    names.push_back("number of cases (" + std::to_string(a.cases) + ", not " +
                    std::to_string(b.cases) + ")");
  for (const auto& [name, hash] : b.inputs) {
    bool same = false;
    for (const auto& known : a.inputs) same = same || known == std::pair(name, hash);
    if (!same) names.push_back(ticked(name));
  }
  if (names.empty()) names.emplace_back("`--set`");
  return joined(names, ", ");
}

}  // namespace palpate::sweep
