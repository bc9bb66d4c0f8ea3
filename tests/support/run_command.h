// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace soslam {

struct CommandResult {
  int exit_code = -1;  // 128 + its number when a signal ended the program
  std::string output;
  std::string errors;
};

// Runs a program with arguments, none of which has a single quote in it, and waits for it.
inline CommandResult RunCommand(const std::vector<std::string>& words) {
  const TemporaryFolder captured;
  std::string line;
  for (const std::string& word : words) line += "'" + word + "' ";
  line += "> '" + (captured / "output").string() + "' 2> '" + (captured / "errors").string() + "'";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, FileBytes(captured / "output"),
          FileBytes(captured / "errors")};
}

}  // namespace soslam
