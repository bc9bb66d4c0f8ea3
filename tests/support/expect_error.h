// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "soslam/base/error.h"

namespace soslam {

// Expects that `action` throws an `ErrorType` whose message is one line and contains all `words`;
// returns the message.
template <typename ErrorType, typename Action>
std::string ExpectError(Action action, const std::vector<std::string>& words) {
  std::string message;
  try {
    action();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ErrorType& error) {
    message = error.what();
    for (const std::string& word : words) EXPECT_THAT(message, testing::HasSubstr(word));
    EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
  }
  return message;
}

// Texts of a file that is refused, with words of the message.
using BadTexts = std::vector<std::pair<std::string, std::vector<std::string>>>;

// Expects that `read` refuses each text, and names `place`.
template <typename Read>
void ExpectBadTexts(const BadTexts& texts, const std::string& place, Read read) {
  for (auto [text, words] : texts) {
    SCOPED_TRACE(text);
    words.push_back(place);
    ExpectError<InputError>([&, &text = text] { read(text); }, words);
  }
}

}  // namespace soslam
