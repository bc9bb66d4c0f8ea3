// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace soslam {

// What results may depend on beside inputs and settings.
struct Software {
  std::string version;                           // "soslam 0.1.0"
  std::string compiler;                          // "GCC 12.2.0"
  std::map<std::string, std::string> libraries;  // version by name: "opencv" is "4.6.0"

  bool operator==(const Software&) const = default;
};

// Of this program. Libraries that can be asked say what runs, of the others (Ceres, CLI11, Eigen,
// fmt, nlohmann-json) it is the version of the headers.
Software ThisSoftware();

}  // namespace soslam
