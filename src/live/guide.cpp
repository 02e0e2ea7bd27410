// A step ends when its goal is reached, not at its planned time.
#include "live/guide.h"

#include <cmath>

#include "base/text.h"

namespace palpate::live {

using scenario::Hold;
using scenario::Indent;
using scenario::Retract;
using scenario::Slide;

bool Guide::is_over(const GuidePlace& place) const {
  const scenario::Step& step = (*steps_)[as_index(step_ - 1)];
  if (const auto* indent = std::get_if<Indent>(&step))
    return indent->to.second ? place.force >= indent->to.value
                             : -place.offset.z() >= indent->to.value;
  if (const auto* retract = std::get_if<Retract>(&step)) return -place.offset.z() <= retract->to;
  if (const auto* slide = std::get_if<Slide>(&step)) {
    const Vec3 way = place.offset - begin_.offset;
    return std::hypot(way.x(), way.y()) >= slide->by;
  }
  const auto* hold = std::get_if<Hold>(&step);
  return hold == nullptr || place.time - begin_.time >= hold->time;
}

void Guide::pass(const GuidePlace& place) {
  if (!any_) begin_ = place;
  any_ = true;
  if (done_ || !is_over(place)) return;
  begin_ = place;
  if (step_ == static_cast<int>(steps_->size()))
    done_ = true;
  else
    ++step_;
}

std::string guidance(const scenario::Step& step) {
  const auto mm = [](double length) { return rounded_text(1e3 * length) + " mm"; };
  const auto speed = [&](double rate) { return " at about " + mm(rate) + "/s"; };
  if (const auto* indent = std::get_if<Indent>(&step))
    return "press " +
           (indent->to.second ? "until the force is " + rounded_text(indent->to.value) + " N"
                              : "to " + mm(indent->to.value)) +
           speed(indent->rate);
  if (const auto* retract = std::get_if<Retract>(&step))
    return "withdraw to " + mm(retract->to) + speed(retract->rate);
  if (const auto* slide = std::get_if<Slide>(&step))
    return "slide sideways by " + mm(slide->by) + speed(slide->rate);
  if (const auto* hold = std::get_if<Hold>(&step))
    return "hold still for " + rounded_text(hold->time) + " s";
  return "nothing";
}

}  // namespace palpate::live
