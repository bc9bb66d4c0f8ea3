// SPDX-License-Identifier: BSD-3-Clause
#include "base/machine.h"

#include <algorithm>
#include <fstream>
#include <thread>

namespace soslam {

Machine ThisMachine() {
  Machine machine{"unknown", std::max(1, static_cast<int>(std::thread::hardware_concurrency()))};
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      machine.cpu = line.substr(colon + 2);
      break;
    }
  }
  return machine;
}

}  // namespace soslam
