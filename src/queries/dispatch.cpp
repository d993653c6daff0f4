// Which instruction set runs: names, detection, the environment variable, and the way from a layout to its kernels.
#include <cstdlib>

#include "base/simd_dispatch.h"
#include "queries/batch.h"
#include "queries/kernels/kernels.h"

namespace boxwood::queries {
namespace {

struct Isa {
  const char* name;
  std::int64_t target;
};

// Best first. The last one runs everywhere.
constexpr Isa kIsas[] = {
#if HWY_ARCH_X86
    {"avx512", HWY_AVX3},
    {"avx2", HWY_AVX2},
    {"sse4", HWY_SSE4},
#elif HWY_ARCH_ARM
    {"neon", HWY_NEON},
#endif
    {"scalar", HWY_BASELINE_SCALAR},
};

constexpr Traversal kTraversals[] = {Traversal::single,      Traversal::packet4, Traversal::range,
                                     Traversal::partition,   Traversal::batch,   Traversal::coherent,
                                     Traversal::interleaved, Traversal::sorted};
constexpr std::uint32_t kSmallestPacket = 16, kLargestPacket = 1024;

bool runs_here(const Isa& isa) {
  // Asked once: on virtual machines each look at the processor takes tens of microseconds.
  static const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return isa.target == HWY_BASELINE_SCALAR || (supported & isa.target) != 0;
}

const Isa* find_isa(std::string_view name) {
  for (const Isa& isa : kIsas)
    if (name == isa.name) return &isa;
  return nullptr;
}

bool has_batch_kernels(layouts::LayoutId layout) {
  return layouts::width(layout) >= 8;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

Result<Mode> find_mode(std::string_view text) {
  for (Mode mode : {Mode::robust, Mode::fast})
    if (text == name(mode)) return mode;
  return {ErrorCode::unknown_name, "unknown mode '" + std::string(text) + "'; there are: robust, fast"};
}

const char* name(Mode mode) {
  return mode == Mode::robust ? "robust" : "fast";
}

Result<Traversal> find_traversal(std::string_view text) {
  for (Traversal traversal : kTraversals)
    if (text == name(traversal)) return traversal;
  return {ErrorCode::unknown_name, "unknown traversal '" + std::string(text) +
                                       "'; there are: single, packet4, range, partition, batch, coherent, "
                                       "interleaved, sorted"};
}

const char* name(Traversal traversal) {
  constexpr const char* kNames[] = {"single", "packet4",  "range",       "partition",
                                    "batch",  "coherent", "interleaved", "sorted"};
  return kNames[static_cast<std::size_t>(traversal)];
}

std::vector<std::string> supported_isas() {
  std::vector<std::string> names;
  for (const Isa& isa : kIsas)
    if (runs_here(isa)) names.emplace_back(isa.name);
  return names;
}

Result<std::string> choose_isa(std::string_view wanted) {
  std::string name(wanted);
  std::string source = "instruction set";
  if (name.empty()) {
    if (const char* variable = std::getenv("BOXWOOD_ISA"); variable && *variable) {
      name = variable;
      source = "instruction set in BOXWOOD_ISA";
    }
  }
  if (name.empty()) return supported_isas().front();
  const Isa* isa = find_isa(name);
  if (!isa || !runs_here(*isa))
    return {isa ? ErrorCode::unsupported : ErrorCode::unknown_name,
            (isa ? source + " '" + name + "' is not supported by this processor"
                 : "unknown " + source + " '" + name + "'") +
                "; there are: " + join(supported_isas())};
  return name;
}

const char* default_layout(std::string_view name) {
  // Where it was measured that nodes of sixteen are no slower.
  const auto isa = choose_isa(name);
  return isa && (*isa == "avx512" || *isa == "avx2" || *isa == "sse4") ? "wide16" : "wide8";
}

Result<Kernels> select_kernels(layouts::LayoutId layout, Mode mode, std::string_view name) {
  const auto chosen = choose_isa(name);
  if (!chosen) return chosen.error();
  const std::int64_t target = find_isa(*chosen)->target;
  switch (layout) {
    case layouts::LayoutId::linear:
      return linear_kernels(mode);
    case layouts::LayoutId::wide4:
      return wide4_kernels(mode, target);
    case layouts::LayoutId::wide8:
      return wide8_kernels(mode, target);
    case layouts::LayoutId::wide8_quads:
      return wide8_quads_kernels(mode, target);
    case layouts::LayoutId::wide16:
      return wide16_kernels(mode, target);
  }
  return {ErrorCode::unknown_name, "there is no layout number " + std::to_string(static_cast<int>(layout))};
}

Result<BatchMethods> select_batch(layouts::LayoutId layout, Mode mode, std::string_view isa) {
  const auto single = select_kernels(layout, mode, isa);
  if (!single) return single.error();
  const auto chosen = choose_isa(isa);
  if (!chosen) return chosen.error();
  BatchMethods methods;
  methods.single = *single;
  methods.has_batch = has_batch_kernels(layout);
  const std::int64_t target = find_isa(*chosen)->target;
  if (methods.has_batch)
    methods.batch = layout == layouts::LayoutId::wide8         ? wide8_batch_kernels(mode, target)
                    : layout == layouts::LayoutId::wide8_quads ? wide8_quads_batch_kernels(mode, target)
                                                               : wide16_batch_kernels(mode, target);
  return methods;
}

Status check_traversal(layouts::LayoutId layout, const TraversalOptions& options) {
  if (options.is_single() || (options.traversal == Traversal::batch && options.terminating)) return {};
  if (layout != layouts::LayoutId::linear && !options.terminating)
    return {ErrorCode::unsupported, std::string("the layout ") + layouts::name(layout) +
                                        " has terminating rays only; non-terminating rays take the layout linear"};
  if (is_batch(options.traversal) && options.traversal != Traversal::batch) {
    if (has_batch_kernels(layout)) return {};
    return {ErrorCode::unsupported, std::string("the layout ") + layouts::name(layout) + " has no traversal " +
                                        name(options.traversal) + "; it takes a layout of 8 or 16 children a node"};
  }
  if (layout != layouts::LayoutId::linear)
    return {ErrorCode::unsupported, std::string("the layout ") + layouts::name(layout) + " has no traversal " +
                                        name(options.traversal) + "; it takes the layout linear"};
  const bool has_size = options.traversal == Traversal::range || options.traversal == Traversal::partition;
  if (has_size && (options.packet_size < kSmallestPacket || options.packet_size > kLargestPacket))
    return {ErrorCode::out_of_range, "the packet size is " + std::to_string(options.packet_size) +
                                         ", it must be from " + std::to_string(kSmallestPacket) + " to " +
                                         std::to_string(kLargestPacket)};
  return {};
}

Result<TraversalKernels> select_traversal(layouts::LayoutId layout, Mode mode, const TraversalOptions& options) {
  if (Status status = check_traversal(layout, options); !status) return status.error();
  switch (options.traversal) {
    case Traversal::packet4:
      return packet4_kernels(mode);
    case Traversal::range:
      return range_kernels(mode);
    case Traversal::partition:
      return partition_kernels(mode);
    default:
      break;
  }
  if (options.terminating)
    return {ErrorCode::invalid_argument, "single, terminating rays and batches are not select_traversal's part"};
  return unending_kernels(mode);
}

}  // namespace boxwood::queries
