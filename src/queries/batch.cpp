// Chunks of a stream of rays: tiles of pixels go as coherent packets, what is not coherent as rays in flight or one by
// one, whichever of the two is faster in this call. No decision changes an answer.
#include "queries/batch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace boxwood::queries {
namespace {

/// Rays in a chunk. Sorting wants many; more chunks share out better over threads.
constexpr std::size_t kChunk = 8192, kSortedChunk = 32768;
/// Rays that go in flight together, at most; few waste time at their end, when fewer and fewer are left. And those of
/// scattered tiles, which are copied together.
constexpr std::size_t kPiece = 2048, kCopiedPiece = 512;
/// Rays that a trial takes for each way; fewer are not timed.
constexpr std::size_t kTrial = 256, kLeastTrial = 128;
/// Rays from one trial to the next: the first ones follow soon, and the more one way is faster the fewer there are.
constexpr std::size_t kBetweenFirstTrials = 2048, kBetweenTrials = 16384;
constexpr float kMoreBetween = 8;  ///< times as many more where one way is twice as fast
/// Of a trial in the mean of all; the first ones weigh more.
constexpr float kLeastWeight = 0.3f;
/// So many incoherent tiles in a row, and of those that follow only one is looked at for each kUnseen taken as such.
constexpr std::size_t kIncoherentRun = 8, kUnseen = 3;
/// Tiles passed over, at most, until a packet is tried again where one has been refused.
constexpr std::size_t kMostSkipped = 32;

/// Where there are fewer rays, looking for rows costs more than tiles gain.
constexpr std::size_t kLeastTiled = 2048;

bool is_sound(const Ray& ray) {
  const Vec3 d = ray.direction;
  const float largest = maximum(maximum(std::fabs(d.x), std::fabs(d.y)), std::fabs(d.z));
  return largest > 0 && is_finite(d) && is_finite(ray.origin) && ray.tmin <= ray.tmax;
}

Vec3 scaled_direction(const Ray& ray) {
  const Vec3 d = ray.direction;
  return (1 / maximum(maximum(std::fabs(d.x), std::fabs(d.y)), std::fabs(d.z))) * d;
}

float largest_component(const Vec3& v) {
  return maximum(maximum(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
}

/// How different two rays are: of their directions, the largest being 1, and of their origins in units of `size`.
float difference(const Ray& a, const Ray& b, float size) {
  return largest_component(scaled_direction(a) - scaled_direction(b)) + largest_component(a.origin - b.origin) / size;
}

/// The k-th of places spread evenly over [0, range) that are no multiples of anything: places at equal distances could
/// all be ends of rows.
std::size_t spread(std::size_t k, std::size_t range) {
  const double x = 0.5 + 0.6180339887498949 * static_cast<double>(k);
  return static_cast<std::size_t>((x - std::floor(x)) * static_cast<double>(range));
}

float size_of(const Box& bounds) {
  const float size = largest_component(bounds.upper - bounds.lower);
  return size > 0 ? size : 1;
}

/// Half a radian across is the most that a packet is tried with. Looks at six rays of the tile.
bool looks_coherent(const Ray* rays, const Tile& tile, float size) {
  constexpr float kMost = 0.5f;
  const Ray* first = nullptr;
  Vec3 direction;
  for (const std::uint32_t row : {0u, tile.rows - 1})
    for (const std::uint32_t column : {0u, tile.columns / 2, tile.columns - 1}) {
      const Ray& ray = rays[tile.first + row * tile.stride + column];
      if (!is_sound(ray)) continue;
      const Vec3 scaled = scaled_direction(ray);
      if (!first)
        first = &ray, direction = scaled;
      else if (!(largest_component(scaled - direction) * size + largest_component(ray.origin - first->origin) <
                 kMost * size))
        return false;
    }
  return first != nullptr;
}

/// The mean difference between rays `distance` apart, capped so that a few edges in the picture don't count.
float mean_difference(std::span<const Ray> rays, std::size_t distance, float size) {
  constexpr std::size_t kSamples = 12;
  constexpr float kCap = 0.25f;
  const std::size_t range = rays.size() - distance;
  float sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const std::size_t i = spread(k, range);
    const Ray &a = rays[i], &b = rays[i + distance];
    if (!is_sound(a) || !is_sound(b)) continue;
    sum += minimum(kCap, difference(a, b, size));
    ++count;
  }
  return 4 * count < kSamples ? kInfinity : sum / static_cast<float>(count);
}

/// The rays of a picture come row by row: then the ray below a ray is as near to it as its neighbour. Finds the
/// distance at which rays differ least, if tiles of such rows are narrower than rows of 64. 0 if there is none.
std::size_t find_row(std::span<const Ray> rays, float size) {
  constexpr std::size_t kLeast = 32, kMost = 4096, kStep = 8, kManyRays = 1 << 18;
  if (rays.size() < kLeastTiled) return 0;
  const std::size_t most = std::min(kMost, rays.size() / 8);
  const float enough = mean_difference(rays, 16, size) / 2;
  std::size_t best = 0;
  float least = kInfinity;
  const auto consider = [&](std::size_t row) {
    const float mean = mean_difference(rays, row, size);
    if (mean < least) least = mean, best = row;
  };
  // A whole picture's width divides the number of its rays. Divisors come in pairs.
  for (std::size_t divisor = 1; divisor <= most && divisor * divisor <= rays.size(); ++divisor) {
    if (rays.size() % divisor != 0) continue;
    const std::size_t other = rays.size() / divisor;
    if (divisor >= kLeast) consider(divisor);
    if (other <= most && other > divisor) consider(other);
  }
  if (least < enough) return best;
  // Part of a picture, or one that has no such width: worth the look only if there is much to be gained.
  if (rays.size() < kManyRays) return 0;
  for (std::size_t row = kLeast; row <= most; row += kStep) consider(row);
  if (best == 0) return 0;
  const std::size_t coarse = best;
  for (std::size_t row = std::max(kLeast, coarse - kStep + 1); row < coarse + kStep; ++row) consider(row);
  return least < enough ? best : 0;
}

void trace_single(const BatchMethods& methods, const layouts::Layout& layout, const Ray* rays, std::size_t count,
                  const BatchAnswers& a) {
  if (a.any())
    methods.single.any(layout, rays, count, a.occluded);
  else
    methods.single.closest(layout, rays, count, a.hits, a.normals);
}

void trace_in_flight(const BatchMethods& methods, const layouts::Layout& layout, const Ray* rays, std::size_t count,
                     const BatchAnswers& a) {
  if (a.any())
    methods.batch.interleaved_any(layout, rays, count, a.occluded);
  else
    methods.batch.interleaved_closest(layout, rays, count, a.hits, a.normals);
}

/// Rays that are copied together, and their answers.
struct Rest {
  Ray rays[kCopiedPiece];
  std::size_t places[kCopiedPiece];
  Hit hits[kCopiedPiece];
  Vec3 normals[kCopiedPiece];
  std::uint8_t occluded[kCopiedPiece];
};

/// Traces a chunk piece by piece.
class ChunkTracer {
 public:
  ChunkTracer(const BatchMethods& methods, const layouts::Layout& layout, FasterWay& faster_way,
              std::span<const Ray> rays, const BatchAnswers& answers)
      : methods_(methods),
        layout_(layout),
        faster_way_(faster_way),
        rays_(rays),
        answers_(answers),
        size_(size_of(layout.bounds)) {}

  /// Tiles of eight by eight where rows are known, else 64 rays in a row each. `always`: packets whatever the rays look
  /// like, and single rays where a packet refuses.
  void tiles(std::size_t row, bool always) {
    if (row == 0) return strips(always);
    for (std::size_t band = 0; band < rays_.size(); band += 8 * row) {
      const std::size_t left = std::min(8 * row, rays_.size() - band), rows = left / row;
      for (std::size_t column = 0; rows && column < row; column += 8)
        tile({band + column, row, static_cast<std::uint32_t>(std::min<std::size_t>(8, row - column)),
              static_cast<std::uint32_t>(rows)},
             always);
      // An unfinished row at the stream's end.
      for (std::size_t begin = rows * row; begin < left; begin += kPacketRays)
        tile({band + begin, 0, static_cast<std::uint32_t>(std::min(kPacketRays, left - begin)), 1}, always);
    }
    flush_rest();
  }

 private:
  enum class Outcome { done, coherent, incoherent };

  /// Where packets are refused they are tried ever more rarely, until one gets through; and tiles behind a run of
  /// incoherent ones are not all looked at.
  Outcome packet(const Tile& tile, bool always) {
    // Behind a tile that was a packet there is one mostly, and it finds out itself if it is none.
    if (!always && !was_packet_) {
      if (unseen_ > 0) return --unseen_, Outcome::incoherent;
      if (!looks_coherent(rays_.data(), tile, size_)) {
        if (++incoherent_ >= kIncoherentRun) unseen_ = kUnseen;
        return Outcome::incoherent;
      }
      incoherent_ = 0;
      if (to_skip_ > 0) return --to_skip_, Outcome::coherent;
    }
    const BatchAnswers& a = answers_;
    const Packet packet = a.any() ? methods_.batch.packet_any(layout_, rays_.data(), tile, a.occluded)
                                  : methods_.batch.packet_closest(layout_, rays_.data(), tile, a.hits, a.normals);
    was_packet_ = packet == Packet::held_together;
    skipping_ = packet == Packet::refused ? std::min(kMostSkipped, 2 * skipping_ + 1) : 0;
    to_skip_ = skipping_;
    return packet == Packet::refused ? Outcome::coherent : Outcome::done;
  }

  void incoherent(std::span<const Ray> rays, const BatchAnswers& answers) {
    for (std::size_t begin = 0; begin < rays.size(); begin += kPiece)
      piece(rays.data() + begin, std::min(kPiece, rays.size() - begin), answers.from(begin));
  }

  void strips(bool always) {
    std::size_t begin = 0;  // of the incoherent rays that wait for what is behind them to be coherent again
    for (std::size_t at = 0; at < rays_.size(); at += kPacketRays) {
      const Tile strip{at, 0, static_cast<std::uint32_t>(std::min(kPacketRays, rays_.size() - at)), 1};
      const Outcome outcome = packet(strip, always);
      if (outcome == Outcome::incoherent) continue;
      incoherent(rays_.subspan(begin, at - begin), answers_.from(begin));
      if (outcome == Outcome::coherent) single(rays_.data() + at, strip.columns, answers_.from(at));
      begin = at + strip.columns;
    }
    if (begin < rays_.size()) incoherent(rays_.subspan(begin), answers_.from(begin));
  }

  void tile(const Tile& tile, bool always) {
    const Outcome outcome = packet(tile, always);
    if (outcome == Outcome::done) return;
    for (std::uint32_t row = 0; row < tile.rows; ++row) {
      const std::size_t begin = tile.first + row * tile.stride;
      // Rays in flight lose on coherent rays: the branches they save are predicted well.
      if (outcome == Outcome::coherent) {
        single(rays_.data() + begin, tile.columns, answers_.from(begin));
        continue;
      }
      if (rest_count_ + tile.columns > kCopiedPiece) flush_rest();
      if (!rest_) rest_ = std::make_unique<Rest>();
      for (std::uint32_t column = 0; column < tile.columns; ++column, ++rest_count_)
        rest_->rays[rest_count_] = rays_[begin + column], rest_->places[rest_count_] = begin + column;
    }
  }

  /// Rays of tiles that were no packets are copied together, traced, and their answers handed out.
  void flush_rest() {
    if (rest_count_ == 0) return;
    BatchAnswers to;
    if (answers_.any())
      to.occluded = rest_->occluded;
    else
      to.hits = rest_->hits, to.normals = answers_.normals ? rest_->normals : nullptr;
    piece(rest_->rays, rest_count_, to);
    for (std::size_t i = 0; i < rest_count_; ++i) {
      const std::size_t place = rest_->places[i];
      if (answers_.any()) {
        answers_.occluded[place] = rest_->occluded[i];
        continue;
      }
      answers_.hits[place] = rest_->hits[i];
      if (answers_.normals) answers_.normals[place] = rest_->normals[i];
    }
    rest_count_ = 0;
  }

  /// Traces the first rays of a piece either way, against the clock; how many. The way that rays go now has its turn
  /// first, since both go on faster than they begin: single rays with the branches that they have taken. Where they
  /// are the other way some go untimed.
  std::size_t trial(const Ray* rays, std::size_t count, const BatchAnswers& answers) {
    using Clock = std::chrono::steady_clock;
    const bool flies = faster_way_.is_in_flight();
    const std::size_t each = std::min(kTrial, count / (flies ? 4 : 2));
    std::size_t at = 0;
    const auto seconds = [&](bool in_flight_now, std::size_t n) {
      const auto start = Clock::now();
      if (in_flight_now)
        in_flight(rays + at, n, answers.from(at));
      else
        single(rays + at, n, answers.from(at));
      at += n;
      return std::chrono::duration<double>(Clock::now() - start).count();
    };
    const double now = seconds(flies, each);
    if (flies) seconds(false, 2 * each);
    const double other = seconds(!flies, each);
    faster_way_.record(flies ? now : other, flies ? other : now);
    return at;
  }

  void piece(const Ray* rays, std::size_t count, const BatchAnswers& answers) {
    if (!methods_.batch.interleaves) return single(rays, count, answers);
    const std::size_t tried = count >= 2 * kLeastTrial && faster_way_.try_both(count) ? trial(rays, count, answers) : 0;
    if (faster_way_.is_in_flight())
      in_flight(rays + tried, count - tried, answers.from(tried));
    else
      single(rays + tried, count - tried, answers.from(tried));
  }

  void single(const Ray* rays, std::size_t count, const BatchAnswers& answers) const {
    trace_single(methods_, layout_, rays, count, answers);
  }
  void in_flight(const Ray* rays, std::size_t count, const BatchAnswers& answers) const {
    trace_in_flight(methods_, layout_, rays, count, answers);
  }

  const BatchMethods& methods_;
  const layouts::Layout& layout_;
  FasterWay& faster_way_;
  std::span<const Ray> rays_;
  const BatchAnswers& answers_;
  float size_;
  bool was_packet_ = false;
  std::size_t skipping_ = 0, to_skip_ = 0, incoherent_ = 0, unseen_ = 0;
  std::size_t rest_count_ = 0;
  std::unique_ptr<Rest> rest_;
};

void trace_sorted(const BatchMethods& methods, const layouts::Layout& layout, std::span<const Ray> rays,
                  const BatchAnswers& answers) {
  const std::size_t n = rays.size();
  AlignedBuffer<Ray> sorted(n);
  const auto places = std::make_unique_for_overwrite<std::uint32_t[]>(n);
  const auto scratch = std::make_unique_for_overwrite<std::uint64_t[]>(2 * n);
  sort_rays(rays, layout.bounds, sorted.span(), {places.get(), n}, {scratch.get(), 2 * n});
  std::vector<Hit> hits(answers.any() ? 0 : n);
  std::vector<Vec3> normals(answers.normals ? n : 0);
  std::vector<std::uint8_t> occluded(answers.any() ? n : 0);
  BatchAnswers to{hits.data(), answers.normals ? normals.data() : nullptr, answers.any() ? occluded.data() : nullptr};
  trace_in_flight(methods, layout, sorted.data(), n, to);
  for (std::size_t i = 0; i < n; ++i) {
    if (answers.any())
      answers.occluded[places[i]] = occluded[i];
    else
      answers.hits[places[i]] = hits[i];
    if (answers.normals) answers.normals[places[i]] = normals[i];
  }
}

}  // namespace

void FasterWay::begin_call(std::size_t rays) {
  if (rays < kBetweenTrials) return;
  until_trial_.store(0, std::memory_order_relaxed);
  // The longer the call, the more of its first trials follow soon: one that was disturbed must not decide for long.
  const auto early = static_cast<std::uint32_t>(std::min<std::size_t>(FasterWay::kFirstTrials, rays / kBetweenTrials));
  early_trials_.store(std::max(early, early_trials_.load(std::memory_order_relaxed)), std::memory_order_relaxed);
  next_weight_.store(std::max(0.6f, next_weight_.load(std::memory_order_relaxed)), std::memory_order_relaxed);
}

bool FasterWay::try_both(std::size_t rays) {
  std::size_t until = until_trial_.load(std::memory_order_relaxed);
  if (until > rays) {
    until_trial_.store(until - rays, std::memory_order_relaxed);
    return false;
  }
  const std::uint32_t early = early_trials_.load(std::memory_order_relaxed);
  if (early > 0) early_trials_.store(early - 1, std::memory_order_relaxed);
  const float difference = std::fabs(log_ratio_.load(std::memory_order_relaxed));
  const auto later = static_cast<std::size_t>((1 + kMoreBetween * difference) * static_cast<float>(kBetweenTrials));
  until_trial_.store(early > 1 ? kBetweenFirstTrials : later, std::memory_order_relaxed);
  return true;
}

void FasterWay::record(double in_flight, double single) {
  // Of two threads one may win: what the other saw is lost, no more. A turn of another process does not decide.
  if (!(in_flight > 0 && single > 0)) return;
  const auto seen = static_cast<float>(std::clamp(std::log2(in_flight / single), -1.0, 1.0));
  const float weight = next_weight_.load(std::memory_order_relaxed);
  log_ratio_.store((1 - weight) * log_ratio_.load(std::memory_order_relaxed) + weight * seen,
                   std::memory_order_relaxed);
  next_weight_.store(std::max(kLeastWeight, weight / (1 + weight)), std::memory_order_relaxed);
}

BatchCut cut_batch(const BatchMethods& methods, std::span<const Ray> rays, Traversal traversal) {
  if (traversal == Traversal::sorted) return {0, kSortedChunk};
  if (!methods.has_batch || traversal == Traversal::interleaved) return {0, kChunk};
  Box bounds;
  for (std::size_t k = 0; k < 16 && !rays.empty(); ++k) {
    const Ray& ray = rays[k * rays.size() / 16];
    if (is_finite(ray.origin)) bounds.grow(ray.origin);
  }
  const float size = size_of(bounds);
  // Only where neighbours are coherent are rows worth looking for.
  std::size_t coherent = 0;
  constexpr std::size_t kSamples = 16;
  for (std::size_t k = 0; k < kSamples && rays.size() >= kLeastTiled; ++k) {
    const std::size_t first = spread(k, rays.size() - 8);
    coherent += looks_coherent(rays.data(), {first, 0, 8, 1}, size);
  }
  const std::size_t row = 2 * coherent >= kSamples ? find_row(rays, size) : 0;
  return {row, row == 0 ? kChunk : 8 * row * std::max<std::size_t>(1, kChunk / (8 * row))};
}

void trace_batch(const BatchMethods& methods, const layouts::Layout& layout, Traversal traversal, std::size_t row,
                 FasterWay& faster_way, std::span<const Ray> rays, const BatchAnswers& answers) {
  if (!methods.has_batch) return trace_single(methods, layout, rays.data(), rays.size(), answers);
  if (traversal == Traversal::sorted) return trace_sorted(methods, layout, rays, answers);
  if (traversal == Traversal::interleaved) return trace_in_flight(methods, layout, rays.data(), rays.size(), answers);
  ChunkTracer(methods, layout, faster_way, rays, answers).tiles(row, traversal == Traversal::coherent);
}

}  // namespace boxwood::queries
