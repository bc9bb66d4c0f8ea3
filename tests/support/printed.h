// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace soslam {

struct Printed {
  std::string output, errors;
};

// What an action prints, which is kept from the terminal, also where it throws.
template <typename Action>
Printed PrintedBy(Action action) {
  struct Capture {
    explicit Capture(Printed* result) : printed(result) {
      testing::internal::CaptureStdout();
      testing::internal::CaptureStderr();
    }
    ~Capture() {
      std::fflush(stdout);
      *printed = {testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
    }
    Printed* printed;
  };
  Printed printed;
  {
    const Capture capture(&printed);
    action();
  }
  return printed;
}

}  // namespace soslam
