// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace soslam {

// Where a program runs, as far as it matters for how long it takes.
struct Machine {
  std::string cpu;  // model name of the processor; "unknown" where the system does not say
  int cores = 1;    // that this process may use, hyper-threads counted
};

Machine ThisMachine();

}  // namespace soslam
