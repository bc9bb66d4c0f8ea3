// SPDX-License-Identifier: BSD-3-Clause
#include "base/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
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

}  // namespace

std::optional<std::string> CrashInOwnProcess(const std::function<void()>& work,
                                             const ProcessLimits& limits) {
  const pid_t process = fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (process == 0) WorkAndExit(work, limits);
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
  }
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
