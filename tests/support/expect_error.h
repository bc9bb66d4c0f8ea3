// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace soslam {

// Expects that `action` throws an `ErrorType` whose message is one line and contains all `words`.
template <typename ErrorType, typename Action>
void ExpectError(Action action, const std::vector<std::string>& words) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ErrorType& error) {
    const std::string message = error.what();
    for (const std::string& word : words) EXPECT_THAT(message, testing::HasSubstr(word));
    EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
  }
}

}  // namespace soslam
