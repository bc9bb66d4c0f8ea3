// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace soslam {

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(0, count, work); });
}

}  // namespace soslam
