// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

// Attribute of functions with loops that the compiler vectorises: it compiles them twice, for any
// processor and for AVX2 with its registers of twice the width, and the program chooses when it
// starts. Both versions do the same operations in the same order (plain AVX2 has no fused
// multiply-add), so the results are the same to the last bit. Arrays are passed as `__restrict`
// where there are more than compilers check for overlap.
//
// Empty under ThreadSanitizer, which cannot start programs that choose functions at load time.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SOSLAM_MULTIVERSION
#endif
#elif defined(__SANITIZE_THREAD__)
#define SOSLAM_MULTIVERSION
#endif
#if !defined(SOSLAM_MULTIVERSION) && defined(__x86_64__) && defined(__ELF__)
#define SOSLAM_MULTIVERSION [[gnu::target_clones("avx2", "default")]]
#elif !defined(SOSLAM_MULTIVERSION)
#define SOSLAM_MULTIVERSION
#endif

// Attribute of functions called by those above: inlined, so that they are compiled for AVX2 as
// well.
#define SOSLAM_FORCE_INLINE [[gnu::always_inline]] inline

namespace soslam {

// Four doubles in one SIMD vector.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
using ThreeFours = std::array<Four, 3>;
// Result of a comparison of two Fours: per element all bits set, or none.
using FourMask = decltype(Four{} < Four{});

// A Four at any address of doubles. (GCC would split a std::memcpy into halves.)
using FourInMemory
    [[gnu::vector_size(4 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
        double;
SOSLAM_FORCE_INLINE void Load(const double* from, Four* four) {
  *four = *reinterpret_cast<const FourInMemory*>(from);
}

// Sum of the four elements.
SOSLAM_FORCE_INLINE double Sum(const Four& four) {
  return (four[0] + four[1]) + (four[2] + four[3]);
}

// Eight floats in one SIMD vector, with the masks and integers to compare and convert them.
using Eight [[gnu::vector_size(8 * sizeof(float))]] = float;
using EightMask = decltype(Eight{} < Eight{});
using EightIntegers [[gnu::vector_size(8 * sizeof(int))]] = int;

using EightInMemory
    [[gnu::vector_size(8 * sizeof(float)), gnu::aligned(alignof(float)), gnu::may_alias]] = float;
SOSLAM_FORCE_INLINE void Load(const float* from, Eight* eight) {
  *eight = *reinterpret_cast<const EightInMemory*>(from);
}

SOSLAM_FORCE_INLINE void Store(const Eight& eight, float* to) {
  *reinterpret_cast<EightInMemory*>(to) = eight;
}

SOSLAM_FORCE_INLINE void SquareRoot(const Eight& of, Eight* root) {
  for (size_t k = 0; k < 8; ++k) (*root)[k] = std::sqrt(of[k]);
}

// Forces later reads of `stored` to come from memory. Otherwise compilers would extract values just
// stored from vector registers one by one, which is slower if they are used as addresses.
template <typename T>
SOSLAM_FORCE_INLINE void ReadFromMemory(const T& stored) {
  asm volatile("" : : "r"(&stored) : "memory");
}

// Sum of the eight elements, in double precision.
SOSLAM_FORCE_INLINE double Sum(const Eight& eight) {
  using EightDoubles [[gnu::vector_size(8 * sizeof(double))]] = double;
  const EightDoubles numbers = __builtin_convertvector(eight, EightDoubles);
  std::array<Four, 2> halves;
  std::memcpy(&halves, &numbers, sizeof(halves));
  return Sum(halves[0] + halves[1]);
}

}  // namespace soslam
