// Events are sorted anew for each range, long lists by digits and therefore in linear time: what keeping sorted lists
// alive through all splits (Wald and Havran 2006) would save is less than what it costs to move and merge them.
#include "builders/parts/plane_events.h"

#include <algorithm>
#include <array>

namespace boxwood::builders {
namespace {

/// Shorter lists are sorted by comparing.
constexpr std::size_t kWorthDigits = 1 << 10;
constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = 1 << kDigitBits;
constexpr int kPasses = 3;

/// Sorts by place, keeping the order of equal ones: events are made in the order of their references.
void sort_events(std::vector<PlaneEvent>& events) {
  if (events.size() < kWorthDigits) {
    std::sort(events.begin(), events.end());
    return;
  }
  std::array<std::array<std::uint32_t, kDigits>, kPasses> begin{};
  const auto digit = [](PlaneEvent event, int pass) { return event.place() >> (pass * kDigitBits) & (kDigits - 1); };
  for (const PlaneEvent event : events)
    for (int pass = 0; pass < kPasses; ++pass) ++begin[static_cast<std::size_t>(pass)][digit(event, pass)];
  std::vector<PlaneEvent> other(events.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    auto& next = begin[static_cast<std::size_t>(pass)];
    if (next[digit(events[0], pass)] == events.size()) continue;  // all have the same digit
    std::uint32_t sum = 0;
    for (std::uint32_t& count : next) sum += std::exchange(count, sum);
    for (const PlaneEvent event : events) other[next[digit(event, pass)]++] = event;
    events.swap(other);
  }
}

}  // namespace

void make_events(std::span<const refs::Reference> references, Executor& executor, AxisEvents (&events)[3]) {
  executor.for_chunks(6, 1, [&](std::size_t task, std::size_t, std::size_t) {
    const int axis = static_cast<int>(task / 2);
    const bool is_end = task % 2 == 1;
    std::vector<PlaneEvent>& list = is_end ? events[axis].ends : events[axis].begins;
    std::vector<PlaneEvent>& flats = events[axis].flats;
    list.reserve(references.size());
    for (std::size_t i = 0; i < references.size(); ++i) {
      const float lower = references[i].lower[axis], upper = references[i].upper[axis];
      if (lower < upper)
        list.emplace_back(is_end ? upper : lower, i);
      else if (!is_end)
        flats.emplace_back(lower, i);
    }
    sort_events(list);
    if (!is_end) sort_events(flats);
  });
}

}  // namespace boxwood::builders
