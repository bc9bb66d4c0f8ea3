// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/run_program.h"

#include <sys/wait.h>

#include <cstdlib>

namespace soslam {
namespace {

// The word quoted for a shell.
std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace

int RunProgram(const std::vector<std::string>& words, const std::filesystem::path& printed) {
  std::string command = "exec";  // so that the status is the program's, not the shell's
  for (const std::string& word : words) command += " " + Quoted(word);
  const int status = std::system((command + " > " + Quoted(printed.string()) + " 2>&1").c_str());
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace soslam
