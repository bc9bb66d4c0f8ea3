// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace soslam {

// Software that results may depend on besides inputs and settings.
struct Software {
  std::string version;                           // "soslam 0.1.0"
  std::string compiler;                          // "GCC 12.2.0"
  std::map<std::string, std::string> libraries;  // name -> version: "opencv" -> "4.6.0"

  bool operator==(const Software&) const = default;
};

// The software of this program. The version of a library is that of the running one where it can be
// queried, otherwise (Ceres, CLI11, Eigen, fmt, nlohmann-json) that of the headers.
Software ThisSoftware();

}  // namespace soslam
