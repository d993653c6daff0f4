// What the batch engine asks of the kernels of one layout, mode and instruction set.
#pragma once

#include "boxwood/queries.h"

namespace boxwood::queries {

/// Most rays in a packet.
inline constexpr std::size_t kPacketRays = 64;

/// The rays of one packet in the caller's array: `rows` rows of `columns` neighbours, their beginnings `stride` apart.
/// One row of up to 64 rays, or up to 8 rows of up to 8.
struct Tile {
  std::size_t first = 0, stride = 0;
  std::uint32_t columns = 0, rows = 1;
};

/// What became of a packet. `refused`: its rays go along too many axes, and their answers are still to be found.
/// `fell_apart`: its rays have gone on alone.
enum class Packet { refused, fell_apart, held_together };

struct BatchKernels {
  Packet (*packet_closest)(const layouts::Layout&, const Ray* rays, const Tile&, Hit* hits, Vec3* normals);
  Packet (*packet_any)(const layouts::Layout&, const Ray* rays, const Tile&, std::uint8_t* occluded);
  /// Many rays in flight.
  void (*interleaved_closest)(const layouts::Layout&, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals);
  void (*interleaved_any)(const layouts::Layout&, const Ray* rays, std::size_t count, std::uint8_t* occluded);
  /// Whether `interleaved` is more than a loop over single rays on this instruction set.
  bool interleaves = false;
};

BatchKernels wide8_batch_kernels(Mode mode, std::int64_t target);
BatchKernels wide8_quads_batch_kernels(Mode mode, std::int64_t target);
BatchKernels wide16_batch_kernels(Mode mode, std::int64_t target);

}  // namespace boxwood::queries
