// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace soslam {

// The hardware that a program runs on, as far as it matters for run times.
struct Machine {
  std::string cpu;  // model name of the processor; "unknown" if the system does not report it
  int cores = 1;    // available to this process, hyper-threads counted
};

Machine ThisMachine();

}  // namespace soslam
