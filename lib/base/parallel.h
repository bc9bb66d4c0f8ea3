// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace soslam {

// Calls work(0) .. work(count - 1), each once, on up to `threads` threads. Work items must not
// share mutable state, so that results do not depend on the number of threads. They are begun in
// that order, and no more once one is seen to have thrown; of the exceptions, that of the lowest
// index, which is the same for any number of threads, is rethrown here.
void ParallelFor(int count, int threads, const std::function<void(int)>& work);

// The same for what takes long: shows how many of these ("frames") are done, see Progress.
void ParallelFor(const char* what, int count, int threads, const std::function<void(int)>& work);

}  // namespace soslam
