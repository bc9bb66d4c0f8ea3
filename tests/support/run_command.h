// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace soslam {

struct CommandResult {
  int exit_code = -1;  // 128 + its number when a signal ended the program
  std::string output;
  std::string errors;
};

// A program that runs while the test goes on, in a process group of its own.
class BackgroundCommand {
 public:
  explicit BackgroundCommand(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    Redirect(&actions, STDOUT_FILENO, "output");
    Redirect(&actions, STDERR_FILENO, "errors");
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    posix_spawn_file_actions_adddup2(&actions, ends[1], kHeldByAll);
    const int error =
        posix_spawnp(&process_, arguments[0], &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    ::close(ends[1]);
    any_runs_ = ends[0];
    if (error != 0) throw std::runtime_error("cannot run " + words[0]);
  }
  ~BackgroundCommand() {
    if (process_ > 0) {
      KillAll();
      Wait();
    }
    ::close(any_runs_);
  }
  BackgroundCommand(const BackgroundCommand&) = delete;
  BackgroundCommand& operator=(const BackgroundCommand&) = delete;

  // kill -9 to the program and all that it started.
  void KillAll() const { ::kill(-process_, SIGKILL); }
  // kill -9 to the program alone.
  void KillFirst() const { ::kill(process_, SIGKILL); }

  // Waits for the program alone; processes that it started may continue.
  CommandResult Wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            FileBytes(captured_ / "output"), FileBytes(captured_ / "errors")};
  }

  // Waits until the program and all that it started have ended.
  CommandResult WaitForAll() {
    char byte;
    while (::read(any_runs_, &byte, 1) != 0) {
    }
    return Wait();
  }

 private:
  // All processes inherit it; when the last one has ended, the other end of the pipe is at its end.
  static constexpr int kHeldByAll = 8;

  void Redirect(posix_spawn_file_actions_t* actions, int descriptor, const std::string& name) {
    const std::string file = (captured_ / name).string();
    posix_spawn_file_actions_addopen(actions, descriptor, file.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
  }

  TemporaryFolder captured_;
  pid_t process_ = 0;
  int any_runs_ = -1;
};

// Runs a program with arguments and waits for it.
inline CommandResult RunCommand(const std::vector<std::string>& words) {
  return BackgroundCommand(words).Wait();
}

// Expects that a program ended with this exit code; what it gave. `file` and `line` are the
// caller's.
inline CommandResult ExpectExit(int exit_code, const CommandResult& result,
                                const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (result.exit_code != exit_code) {
    ADD_FAILURE_AT(file, line) << "exit code " << result.exit_code << "; expected " << exit_code
                               << "\n"
                               << result.output << result.errors;
  }
  return result;
}
// Expects that a program succeeded; what it printed.
inline std::string ExpectSuccess(const CommandResult& result, const char* file = __builtin_FILE(),
                                 int line = __builtin_LINE()) {
  return ExpectExit(0, result, file, line).output;
}

}  // namespace soslam
