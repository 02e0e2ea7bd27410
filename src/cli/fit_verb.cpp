// `palpate fit`: fits one curve to two columns of a text table.
#include <algorithm>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/contact_model.h"
#include "fit/fit_table.h"
#include "fit/prony.h"
#include "measured/measured.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void check_model(const std::string& name) {
  std::vector<std::string> known;
  for (const fit::ModelInfo& one : fit::models()) known.emplace_back(one.name);
  known.insert(known.end(), further_models.begin(), further_models.end());
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const auto near = nearest(name, known);
  refuse("`--model` does not know `" + name + "`" +
         (near ? "; did you mean `" + *near + "`?" : "; it is one of " + joined(known, ", ")));
}

// Refuses options that the model does not use, and a model without its required options.
void check_options(const Fit& command) {
  struct Option {
    const char* name;
    bool given;
    std::initializer_list<std::string_view> models;
    bool required;
    const char* example;
  };
  for (const Option& option :
       {Option{"--radius", !command.radius.empty(), {"hertz", "layer"}, true, "\"11 mm\""},
        Option{"--poisson", command.poisson_ratio >= 0, {"hertz", "layer"}, true, "0.45"},
        Option{"--thickness", !command.thickness.empty(), {"layer"}, true, "\"5 mm\""},
        Option{"--base", !command.base.empty(), {"layer"}, false, "bonded"},
        Option{"--terms", command.terms > 0, {"prony", "prony_creep"}, true, "2"}}) {
    const bool fits = is_one_of(command.model, option.models);
    if (option.given && !fits)
      refuse("`" + std::string(option.name) + "` is not used by the model `" + command.model +
             "`; leave it out");
    if (!option.given && fits && option.required)
      refuse("the model `" + command.model + "` wants `" + option.name + "`; write it as `" +
             option.name + " " + option.example + "`");
  }
  if (command.x_origin != 0.0 && is_one_of(command.model, {"hertz", "layer"}))
    refuse("`--origin` is not used by the model `" + command.model +
           "`, which fits the contact point; leave it out");
}

double length_of(const std::string& option, const std::string& text) {
  double size = 0.0;
  try {
    size = parse_quantity(text, unit::mm);
  } catch (const std::invalid_argument& wrong) {
    refuse("`" + option + "` " + wrong.what());
  }
  if (!(size > 0.0)) refuse("`" + option + "` is `" + text + "`; give a length above 0");
  return size;
}

contact::LayerBase base_of(const std::string& word) {
  if (word.empty() || word == "bonded") return contact::LayerBase::bonded;
  if (word == "frictionless") return contact::LayerBase::frictionless;
  refuse("`--base` does not know `" + word + "`; it is bonded or frictionless");
}

void check_axis(const measured::MeasuredCurve& curve, const measured::MeasuredAxis& axis,
                const Unit& wanted, const std::string& option) {
  if (axis.dimension == wanted.dimension) return;
  const std::string known = axis.has_unit ? dimension_name(axis.dimension) : "without a unit";
  throw InputError({curve.file, 0, 0},
                   "`" + axis.column + "` is " + known + ", and this model wants a " +
                       wanted.quantity + "; name another column with `" + option + "`, or give `" +
                       option + "-unit " + wanted.symbol + "`");
}

fit::Fit contact_fit(const Fit& command, const measured::MeasuredCurve& curve) {
  check_axis(curve, curve.x_axis, unit::mm, "--x");
  check_axis(curve, curve.y_axis, unit::N, "--y");
  fit::ContactTest test{.radius = length_of("--radius", command.radius),
                        .poisson_ratio = command.poisson_ratio,
                        .base = base_of(command.base)};
  if (command.model == "layer") test.thickness = length_of("--thickness", command.thickness);
  return fit::fit_contact(curve.x, curve.y, test);
}

fit::Fit fitted(const Fit& command, const measured::MeasuredCurve& curve) {
  const fit::Options options{
      .x_unit = curve.x_axis.unit, .y_unit = curve.y_axis.unit, .x_origin = command.x_origin};
  if (is_one_of(command.model, {"hertz", "layer"})) return contact_fit(command, curve);
  if (const auto model = fit::find_model(command.model))
    return fit::regress(curve.x_written, curve.y_written, *model, options);
  const fit::PronySeries series{
      command.model == "prony" ? fit::PronySeries::Kind::relaxation : fit::PronySeries::Kind::creep,
      command.terms};
  return fit::fit_prony(curve.x_written, curve.y_written, series, options);
}

void say_what_is_odd(const fit::Fit& result) {
  if (result.left_out > 0)
    Talk::error("note: " + std::to_string(result.left_out) +
                (result.left_out == 1 ? " point is" : " points are") +
                " left out: not finite, or x <= 0 where its logarithm is needed");
  if (!is_one_of(result.name, {"prony", "prony_creep"})) return;
  for (std::size_t i = 1; i < result.parameters.size(); i += 2)
    if (result.parameters[i].estimate < 0.0)
      Talk::error("note: `" + result.parameters[i].name +
                  "` is below 0, which no passive tissue has; give fewer `--terms`");
}

}  // namespace

int perform(const Fit& command, const Arguments&, const Talk&) {
  check_model(command.model);
  check_options(command);
  DataOptions columns = command.columns;
  columns.blanks = DataOptions::Blanks::keep;  // the fit counts all points that it leaves out
  const measured::MeasuredCurve curve = measured::read_measured(command.data, columns);
  for (const std::string& note : curve.notes) Talk::error("note: " + note);
  fit::Fit result;
  try {
    result = fitted(command, curve);
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    if (!problem.place.file.empty() || problem.message.starts_with("palpate: ")) throw;
    throw InputError({command.data, 0, 0}, problem.message);
  }
  const std::vector<fit::NamedFit> named{
      {columns.case_name, curve.y_axis.column + " over " + curve.x_axis.column, result}};
  print(record::csv_text(fit::fit_table(named)));
  say_what_is_odd(result);
  return exit_good;
}

}  // namespace palpate::cli
