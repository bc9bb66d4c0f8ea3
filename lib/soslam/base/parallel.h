// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "soslam/base/progress.h"

namespace soslam {

// Calls work(0) .. work(count - 1), each once, on up to `threads` threads. Work items must not
// share mutable state, so that results do not depend on the number of threads. Items start in order
// of their index, and none starts after one was seen to throw. Of the exceptions, that of the
// lowest index is rethrown here; it is the same for any number of threads.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& work);

// ParallelFor for long loops: shows the progress in `what` ("frames"), see Progress.
void ParallelFor(const char* what, size_t count, int threads,
                 const std::function<void(size_t)>& work);

// Calls make(0) .. make(count - 1) on threads, and take(i, what was made) in order; few of what was
// made are in memory at a time. Shows the progress in `what`, see Progress.
template <typename Make, typename Take>
void MakeInOrder(const char* what, size_t count, int threads, const Make& make, const Take& take) {
  Progress progress(what, static_cast<int>(count));
  const size_t batch = 4 * static_cast<size_t>(threads);
  for (size_t begin = 0; begin < count; begin += batch) {
    std::vector<decltype(make(begin))> made(std::min(batch, count - begin));
    ParallelFor(made.size(), threads, [&](size_t i) {
      made[i] = make(begin + i);
      progress.Step();
    });
    for (size_t i = 0; i < made.size(); ++i) take(begin + i, made[i]);
  }
}

}  // namespace soslam
