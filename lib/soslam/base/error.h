// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace soslam {

// Exit codes of every stage; docs and --help list the same numbers.
enum class ExitCode : int {
  kDone = 0,
  kSettings = 2,       // wrong usage or a setting out of range
  kInput = 3,          // an input is missing, unreadable or not valid
  kNothingUsable = 4,  // ran, but nothing usable came out
  kNumerical = 5,      // a solver failed
  kInternal = 70,      // our bug
};

// Base of all errors that end a stage. The message is one line for a person: where (file, field or
// row), what was found, what was expected.
class Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& message)
      : std::runtime_error(message), exit_code_(exit_code) {}
  ExitCode exit_code() const { return exit_code_; }

 private:
  ExitCode exit_code_;
};

template <ExitCode kExitCode>
class ErrorWith : public Error {
 public:
  explicit ErrorWith(const std::string& message) : Error(kExitCode, message) {}
};

using SettingsError = ErrorWith<ExitCode::kSettings>;
using InputError = ErrorWith<ExitCode::kInput>;
using NothingUsableError = ErrorWith<ExitCode::kNothingUsable>;
using NumericalError = ErrorWith<ExitCode::kNumerical>;

}  // namespace soslam
