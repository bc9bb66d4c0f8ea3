// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace soslam {

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  // More threads than cores bring nothing but a warning on stderr.
  tbb::task_arena arena(std::clamp(threads, 1, tbb::info::default_concurrency()));
  arena.execute([&] { tbb::parallel_for(0, count, work); });
}

}  // namespace soslam
