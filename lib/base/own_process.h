// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace soslam {

// Does `work` in a process of its own, a copy of this one, whose memory and messages are lost with
// it: for libraries that crash on damaged files. Says how that process ended where it did not come
// to an end by itself, as in "signal 11 (Segmentation fault)"; none also where `work` throws. Not
// while other threads are running.
std::optional<std::string> CrashInOwnProcess(const std::function<void()>& work);

}  // namespace soslam
