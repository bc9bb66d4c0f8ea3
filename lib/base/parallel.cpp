// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "base/progress.h"

namespace soslam {

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  std::vector<std::exception_ptr> errors(static_cast<size_t>(std::max(0, count)));
  std::atomic<int> next = 0;
  std::atomic<int> end = count;  // items after an error are not started
  const auto work_until_done = [&] {
    for (int i = next++; i < end; i = next++) {
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
    static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::vector<std::jthread> others;  // joined at the end of this block
    for (int i = 1; i < std::min({count, threads, cores}); ++i) {
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

void ParallelFor(const char* what, int count, int threads, const std::function<void(int)>& work) {
  Progress progress(what, count);
  ParallelFor(count, threads, [&](int i) {
    work(i);
    progress.Step();
  });
}

}  // namespace soslam
