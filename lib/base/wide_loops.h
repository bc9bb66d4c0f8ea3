// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

// Before a function whose loops the compiler turns into vector code: compiles it twice, for any
// processor and for those with AVX2, which take twice as many numbers at once; the program chooses
// when it starts. Both do the same operations in the same order (AVX2 alone has no fused multiply
// and add), so the results are the same to the last bit. Arrays come by `__restrict` where there
// are more than compilers compare for overlap.
//
// ThreadSanitizer cannot start programs that choose.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SOSLAM_WIDE_LOOPS
#endif
#elif defined(__SANITIZE_THREAD__)
#define SOSLAM_WIDE_LOOPS
#endif
#if !defined(SOSLAM_WIDE_LOOPS) && defined(__x86_64__) && defined(__ELF__)
#define SOSLAM_WIDE_LOOPS [[gnu::target_clones("avx2", "default")]]
#elif !defined(SOSLAM_WIDE_LOOPS)
#define SOSLAM_WIDE_LOOPS
#endif

// Before what such a function calls: it is compiled for wide registers only as a part of it.
#define SOSLAM_IN_WIDE_LOOPS [[gnu::always_inline]] inline

// Before a function that is for processors with AVX2 only, where HasWideRegisters().
#if defined(__x86_64__)
#define SOSLAM_FOR_AVX2 [[gnu::target("avx2")]]
#else
#define SOSLAM_FOR_AVX2
#endif

namespace soslam {

// Whether this processor has AVX2.
inline bool HasWideRegisters() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

// Four numbers side by side.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
using ThreeFours = std::array<Four, 3>;
// What wide registers load at once. A compiler that is not told may align a Four, and whatever has
// some as its members, by half of it: what a function of SOSLAM_WIDE_LOOPS gets is aligned by this.
inline constexpr size_t kFourAlignment = sizeof(Four);
// What comparing them gives: all bits of a number's place, or none.
using FourMask = decltype(Four{} < Four{});

// Among other numbers. (GCC would copy what std::memcpy takes by halves.)
using FourInMemory
    [[gnu::vector_size(4 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
        double;
SOSLAM_IN_WIDE_LOOPS void Load(const double* from, Four* four) {
  *four = *reinterpret_cast<const FourInMemory*>(from);
}

SOSLAM_IN_WIDE_LOOPS void Store(const Four& four, double* to) {
  *reinterpret_cast<FourInMemory*>(to) = four;
}

// Whether it holds for any of the four.
SOSLAM_IN_WIDE_LOOPS bool Any(const FourMask& mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

SOSLAM_IN_WIDE_LOOPS void SquareRoot(const Four& of, Four* root) {
  for (size_t k = 0; k < 4; ++k) (*root)[k] = std::sqrt(of[k]);
}

// All four together.
SOSLAM_IN_WIDE_LOOPS double Sum(const Four& four) {
  return (four[0] + four[1]) + (four[2] + four[3]);
}

// Of four fours: the i-th sum is that of fours[i], added in the order of Sum.
SOSLAM_IN_WIDE_LOOPS void SumEach(const Four* fours, Four* sums) {
  std::array<Four, 2> pairs;
  for (size_t i = 0; i < 2; ++i) {
    const Four &a = fours[2 * i], &b = fours[2 * i + 1];
    pairs[i] =
        __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  }
  *sums = __builtin_shufflevector(pairs[0], pairs[1], 0, 1, 4, 5) +
          __builtin_shufflevector(pairs[0], pairs[1], 2, 3, 6, 7);
}

// Eight numbers of single precision side by side, and how they are compared and converted.
using Eight [[gnu::vector_size(8 * sizeof(float))]] = float;
using EightMask = decltype(Eight{} < Eight{});
using EightIntegers [[gnu::vector_size(8 * sizeof(int))]] = int;

using EightInMemory
    [[gnu::vector_size(8 * sizeof(float)), gnu::aligned(alignof(float)), gnu::may_alias]] = float;
SOSLAM_IN_WIDE_LOOPS void Load(const float* from, Eight* eight) {
  *eight = *reinterpret_cast<const EightInMemory*>(from);
}

using EightIntegersInMemory
    [[gnu::vector_size(8 * sizeof(int)), gnu::aligned(alignof(int)), gnu::may_alias]] = int;
SOSLAM_IN_WIDE_LOOPS void Load(const int* from, EightIntegers* eight) {
  *eight = *reinterpret_cast<const EightIntegersInMemory*>(from);
}

SOSLAM_IN_WIDE_LOOPS void Store(const EightIntegers& eight, int* to) {
  *reinterpret_cast<EightIntegersInMemory*>(to) = eight;
}

SOSLAM_IN_WIDE_LOOPS void Store(const Eight& eight, float* to) {
  *reinterpret_cast<EightInMemory*>(to) = eight;
}

SOSLAM_IN_WIDE_LOOPS void SquareRoot(const Eight& of, Eight* root) {
  for (size_t k = 0; k < 8; ++k) (*root)[k] = std::sqrt(of[k]);
}

// What is read from here on comes from memory. Compilers would take what they just stored, number
// by number, out of the registers it came from, which takes longer where numbers are addresses.
template <typename T>
SOSLAM_IN_WIDE_LOOPS void ReadFromMemory(const T& stored) {
  asm volatile("" : : "r"(&stored) : "memory");
}

// All eight together, in double precision.
SOSLAM_IN_WIDE_LOOPS double Sum(const Eight& eight) {
  using EightDoubles [[gnu::vector_size(8 * sizeof(double))]] = double;
  const EightDoubles numbers = __builtin_convertvector(eight, EightDoubles);
  std::array<Four, 2> halves;
  std::memcpy(&halves, &numbers, sizeof(halves));
  return Sum(halves[0] + halves[1]);
}

// Takes the numbers of `from` where the mask holds.
SOSLAM_IN_WIDE_LOOPS void Replace(const FourMask& where, const Four& from, Four* to) {
  *to = where ? from : *to;
}

template <size_t kCount>
SOSLAM_IN_WIDE_LOOPS void Replace(const FourMask& where, const std::array<Four, kCount>& from,
                                  std::array<Four, kCount>* to) {
  for (size_t i = 0; i < kCount; ++i) Replace(where, from[i], &(*to)[i]);
}

}  // namespace soslam
