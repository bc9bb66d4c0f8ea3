// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace soslam {

// The message as one line of printable text. Messages quote files, which may hold any bytes:
// control characters are escaped. A long message keeps its begin and its end, which hold the place
// of the error and what was expected.
std::string OneLine(const std::string& message);

}  // namespace soslam
