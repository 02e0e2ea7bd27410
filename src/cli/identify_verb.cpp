// `palpate identify`: the properties behind a measured curve.
#include "base/error.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "fit/identified_tables.h"
#include "fit/identify.h"
#include "fit/model.h"
#include "record/csv.h"
#include "report/identified_folder.h"
#include "report/machine.h"

namespace palpate::cli {
namespace {

fit::Measurement read_measurement(const Identify& command) {
  const record::Table table = record::read_csv(command.data);
  fit::Measurement measured;
  const auto read = [&](const std::string& name, std::vector<double>& values, Dimension& dim) {
    const int column = table.find(name);
    if (column < 0) throw InputError({command.data, 1, 0}, "has no column `" + name + "`");
    const std::string symbol = fit::column_unit(name);
    for (const Unit& unit : {unit::mm, unit::N, unit::kPa, unit::s})
      if (symbol == unit.symbol) dim = unit.dimension;
    const double factor = symbol == "mm" ? 1e-3 : symbol == "kPa" ? 1e3 : 1.0;
    for (const auto& row : table.rows)
      values.push_back(std::get<double>(row[static_cast<std::size_t>(column)]) * factor);
  };
  measured.x_name = command.x;
  measured.y_name = command.y;
  read(command.x, measured.x, measured.x_dimension);
  read(command.y, measured.y, measured.y_dimension);
  return measured;
}

}  // namespace

int identify(const Identify& command, const Arguments& arguments, const Talk& talk) {
  const std::string started = report::utc_now();
  const scenario::Family family = scenario::read(command.scenario, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  if (family.cases.size() > 1)
    talk.say("note: of " + std::to_string(family.cases.size()) + " cases the first is fitted, " +
             family.cases.front().name);
  const std::vector<fit::Unknown> unknowns =
      fit::read_unknowns(command.unknowns, family.cases.front().scenario);
  report::IdentifiedFolder folder(command.out, family.name, command.force);
  const fit::Measurement measured = read_measurement(command);
  fit::IdentifyOptions options;
  if (command.noise == "relative") options.noise = fit::Noise::relative;

  const std::atomic<bool>& stop = listen_for_interrupts(exit_interrupted);
  fit::Identification found;
  try {
    found = fit::identify(measured, family, unknowns, stop, options);
  } catch (const InputError&) {
    if (!stop.load()) throw;
    Talk::error("palpate: interrupted; nothing was written");
    return exit_interrupted;
  }
  for (const std::string& note : found.notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  for (const std::string& warning :
       folder.write(found, family, command.data, {arguments.given, started}))
    talk.warn(warning);
  if (talk.json()) {
    print(json_lines(fit::identified_table(found)));
  } else {
    for (const std::string& line : fit::identified_sentences(found)) print(line + "\n");
  }
  talk.say(folder.path() +
           ": identified.csv, residuals.csv, profile.csv, curve.svg, scenario.toml");
  return exit_good;
}

}  // namespace palpate::cli
