// The events of a plane sweep: where boxes begin, end and lie flat on one axis, sorted.
#pragma once

#include <span>
#include <vector>

#include "boxwood/parallel.h"
#include "boxwood/refs.h"
#include "builders/parts/ordered_bits.h"

namespace boxwood::builders {

/// A position on an axis and the reference it belongs to, as one integer that sorts by position, then by reference.
class PlaneEvent {
 public:
  PlaneEvent() = default;
  PlaneEvent(float position, std::size_t reference)
      : key_(static_cast<std::uint64_t>(ordered_bits(position)) << 32 | static_cast<std::uint32_t>(reference)) {}
  /// Positions compare like these; no position's is as high as kPastAll.
  std::uint32_t place() const { return static_cast<std::uint32_t>(key_ >> 32); }
  std::uint32_t reference() const { return static_cast<std::uint32_t>(key_); }
  friend bool operator<(PlaneEvent a, PlaneEvent b) { return a.key_ < b.key_; }

  static constexpr std::uint32_t kPastAll = ~0u;

 private:
  std::uint64_t key_;
};

/// The events of one axis.
struct AxisEvents {
  std::vector<PlaneEvent> begins, ends;  ///< of boxes that are not flat on this axis
  std::vector<PlaneEvent> flats;
};

/// Sorted events of all three axes. Linear in the number of references: long lists are sorted by digits.
void make_events(std::span<const refs::Reference> references, Executor& executor, AxisEvents (&events)[3]);

/// A position where something begins, ends or lies flat, and how many events come before and after it.
struct PlaneStop {
  float position;
  std::uint32_t begins, ends, flats;           ///< before it
  std::uint32_t begins_to, ends_to, flats_to;  ///< up to and with it
};

/// Calls f(PlaneStop) for each different position, in increasing order.
template <class F>
void for_each_stop(const AxisEvents& events, F f) {
  const auto place = [](const std::vector<PlaneEvent>& list, std::uint32_t i) {
    return i < list.size() ? list[i].place() : PlaneEvent::kPastAll;
  };
  PlaneStop stop{};
  while (true) {
    const std::uint32_t here =
        std::min({place(events.begins, stop.begins), place(events.ends, stop.ends), place(events.flats, stop.flats)});
    if (here == PlaneEvent::kPastAll) return;
    while (place(events.begins, stop.begins_to) == here) ++stop.begins_to;
    while (place(events.ends, stop.ends_to) == here) ++stop.ends_to;
    while (place(events.flats, stop.flats_to) == here) ++stop.flats_to;
    stop.position = from_ordered_bits(here);
    f(stop);
    stop.begins = stop.begins_to, stop.ends = stop.ends_to, stop.flats = stop.flats_to;
  }
}

}  // namespace boxwood::builders
