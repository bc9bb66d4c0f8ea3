// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

namespace soslam {

// Kinds of noise. Each kind draws from its own generators, so that changing one kind leaves the
// others unchanged.
enum class NoiseKind : uint32_t { kDetection = 1, kOdometry = 2, kImage = 3 };

// The generator for one frame, and object id or 0.
inline std::mt19937 NoiseGenerator(int seed, NoiseKind kind, int frame_index, int object_id) {
  std::seed_seq sequence = {static_cast<uint32_t>(seed), static_cast<uint32_t>(kind),
                            static_cast<uint32_t>(frame_index), static_cast<uint32_t>(object_id)};
  return std::mt19937(sequence);
}

}  // namespace soslam
