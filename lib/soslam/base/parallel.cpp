// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "soslam/base/progress.h"

namespace soslam {

void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& work) {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<size_t> next = 0;
  std::atomic<size_t> end = count;  // items after an error are not started
  const auto work_until_done = [&] {
    for (size_t i = next++; i < end; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
        end = i;
      }
    }
  };
  {
    // Queried once: the system reads it from a file.
    static const size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;  // joined at the end of this block
    for (size_t i = 1; i < std::min({count, static_cast<size_t>(std::max(1, threads)), cores});
         ++i) {
      try {
        others.emplace_back(work_until_done);
      } catch (const std::system_error&) {
        break;  // the system allows no more threads; the existing ones do all the work
      }
    }
    work_until_done();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void ParallelFor(const char* what, size_t count, int threads,
                 const std::function<void(size_t)>& work) {
  Progress progress(what, static_cast<int>(count));
  ParallelFor(count, threads, [&](size_t i) {
    work(i);
    progress.Step();
  });
}

}  // namespace soslam
