// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace soslam {

// A message as one line that a terminal takes for text, as messages quote files, which may hold
// anything; of a long one its begin and end, which have its place and what was expected.
std::string OneLine(const std::string& message);

}  // namespace soslam
