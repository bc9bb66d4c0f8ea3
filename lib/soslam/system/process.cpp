// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/system/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <system_error>
#include <thread>

namespace soslam {
namespace {

constexpr int kOutOfMemory = 71;

// Size of this process' address space (sanitizers take terabytes); none if the system does not
// report it.
std::optional<std::uint64_t> AddressBytes() {
  std::uint64_t pages = 0;
  std::ifstream stream("/proc/self/statm");
  if (!(stream >> pages)) return std::nullopt;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void Lower(__rlimit_resource resource, rlim_t value) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur <= value) return;
  limit.rlim_cur = value;
  setrlimit(resource, &limit);
}

[[noreturn]] void WorkAndExit(const std::function<void()>& work, const ProcessLimits& limits) {
  Lower(RLIMIT_CPU, limits.cpu_s);
  if (const auto bytes = AddressBytes()) Lower(RLIMIT_AS, *bytes + limits.memory_bytes);
  const rlimit no_core_dump{0, 0};
  setrlimit(RLIMIT_CORE, &no_core_dump);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    work();
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (...) {  // thrown again when the caller does the work in its own process
  }
  _exit(0);
}

int WaitForExit(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
  }
  return status;
}

constexpr int kNoSuchProgram = 127;

[[noreturn]] void BecomeProgram(const std::vector<char*>& words, int output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvp(words.front(), words.data());
  _exit(kNoSuchProgram);
}

// Calls `use_line` with each line of a stream, up to its end.
void ForEachLine(int stream, const std::function<void(const std::string&)>& use_line) {
  std::string rest;
  char buffer[4096];
  for (ssize_t count; (count = read(stream, buffer, sizeof(buffer))) != 0;) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;
    rest.append(buffer, static_cast<size_t>(count));
    for (size_t end = rest.find('\n'); end != rest.npos; end = rest.find('\n')) {
      use_line(rest.substr(0, end));
      rest.erase(0, end + 1);
    }
  }
  if (!rest.empty()) use_line(rest);
}

}  // namespace

std::optional<int> FollowProgram(const std::vector<std::string>& words,
                                 const std::function<void(const std::string&)>& use_line) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t process = fork();
  if (process == 0) BecomeProgram(arguments, ends[1]);
  close(ends[1]);
  if (process > 0) ForEachLine(ends[0], use_line);
  close(ends[0]);
  if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
  const int status = WaitForExit(process);
  if (WIFSIGNALED(status)) return 128 + WTERMSIG(status);
  if (WEXITSTATUS(status) == kNoSuchProgram) return std::nullopt;
  return WEXITSTATUS(status);
}

std::optional<std::string> CrashInOwnProcess(const std::function<void()>& work,
                                             const ProcessLimits& limits) {
  const pid_t process = fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (process == 0) WorkAndExit(work, limits);
  const int status = WaitForExit(process);
  if (WIFSIGNALED(status)) {
    return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) == kOutOfMemory) {
    return fmt::format("too little memory ({} bytes more)", limits.memory_bytes);
  }
  if (WEXITSTATUS(status) != 0) return fmt::format("exit code {}", WEXITSTATUS(status));
  return std::nullopt;
}

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
