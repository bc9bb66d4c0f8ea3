// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "base/progress.h"

namespace soslam {

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  // More threads than cores bring nothing but a warning on stderr.
  tbb::task_arena arena(std::clamp(threads, 1, tbb::info::default_concurrency()));
  std::vector<std::exception_ptr> errors(static_cast<size_t>(std::max(0, count)));
  arena.execute([&] {
    tbb::parallel_for(0, count, [&](int i) {
      try {
        work(i);
      } catch (...) {
        errors[static_cast<size_t>(i)] = std::current_exception();
      }
    });
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void ParallelFor(const char* what, int count, int threads, const std::function<void(int)>& work) {
  Progress progress(what, count);
  ParallelFor(count, threads, [&](int i) {
    work(i);
    progress.Step();
  });
}

}  // namespace soslam
