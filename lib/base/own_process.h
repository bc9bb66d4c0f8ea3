// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace soslam {

// How much a process of its own may take before it is ended.
struct ProcessLimits {
  std::uint64_t cpu_s = 120;                            // of all its threads
  std::uint64_t memory_bytes = std::uint64_t{8} << 30;  // beyond what this one has
};

// Does `work` in a process of its own, a copy of this one, whose memory and messages are lost with
// it: for libraries that crash on damaged files. Says how that process ended where it did not come
// to an end by itself, as in "signal 11 (Segmentation fault)", or that it took more than the
// limits; none also where `work` throws anything but std::bad_alloc. Not while other threads are
// running.
std::optional<std::string> CrashInOwnProcess(const std::function<void()>& work,
                                             const ProcessLimits& limits = {});

}  // namespace soslam
