// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/description.h"

namespace soslam {

// Limits of a child process, which is ended when it exceeds them.
struct ProcessLimits {
  std::uint64_t cpu_s = 120;                            // of all its threads together
  std::uint64_t memory_bytes = std::uint64_t{8} << 30;  // in addition to this process' own
};

// Runs `work` in a forked child process, whose memory and output are lost with it: for libraries
// that crash on damaged files. Returns how the child died, as in "signal 11 (Segmentation fault)",
// or the limit that it exceeded; none if it ended by itself, also where `work` throws anything but
// std::bad_alloc. Must not be called while other threads are running.
std::optional<std::string> CrashInOwnProcess(const std::function<void()>& work,
                                             const ProcessLimits& limits = {});

// Runs a program, found on PATH, with these arguments, and calls `use_line` with each line that it
// prints on stdout or stderr, without its end. The program ends with this process, at the latest.
// Returns its exit code, 128 + the number of the signal that ended it; none if there is no such
// program. `use_line` must not throw.
std::optional<int> FollowProgram(const std::vector<std::string>& words,
                                 const std::function<void(const std::string&)>& use_line);

// The hardware that a program runs on, as far as it matters for run times.
struct Machine {
  std::string cpu;  // model name of the processor; "unknown" if the system does not report it
  int cores = 1;    // available to this process, hyper-threads counted
};

template <typename Visitor>
void Describe(Visitor& visit, Machine& machine) {
  visit.Field("cpu", &machine.cpu, "model name of the processor");
  visit.Field("cores", &machine.cores, "available to the process", kAtLeastOne);
}

Machine ThisMachine();

}  // namespace soslam
