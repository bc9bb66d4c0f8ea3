// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace soslam {

// Calls work(0) .. work(count - 1), each once, on up to `threads` threads. Work items must not
// share mutable state, so that results do not depend on the number of threads. Items start in order
// of their index, and none starts after one was seen to throw. Of the exceptions, that of the
// lowest index is rethrown here; it is the same for any number of threads.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& work);

// The same for long loops: shows the progress in `what` ("frames"), see Progress.
void ParallelFor(const char* what, size_t count, int threads,
                 const std::function<void(size_t)>& work);

}  // namespace soslam
