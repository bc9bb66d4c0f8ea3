// SPDX-License-Identifier: BSD-3-Clause
// soslam-fuzz --target=<name> [libFuzzer's arguments]: all targets in one program, as they share
// all but a few lines.
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "fuzz/fuzz_target.h"

namespace {

soslam::FuzzTarget::Read g_read;

[[noreturn]] void ListTargets() {
  for (const auto& [name, read] : soslam::FuzzTarget::All()) std::cout << name << "\n";
  std::exit(0);
}

}  // namespace

// What the HDF5 library does not free of a damaged file ends with the program.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

// libFuzzer leaves arguments alone that begin with two dashes.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view kTarget = "--target=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (argument == "--list") ListTargets();
    if (!argument.starts_with(kTarget)) continue;
    const auto found = soslam::FuzzTarget::All().find(std::string(argument.substr(kTarget.size())));
    if (found != soslam::FuzzTarget::All().end()) g_read = found->second;
  }
  if (g_read) return 0;
  std::cerr << "expected --target=<name>, one of those that --list prints\n";
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  g_read(soslam::HostileInput({reinterpret_cast<const char*>(data), size}));
  return 0;
}
