// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {

// One change to a valid JSON file, and what the error has to say about it.
struct FieldEdit {
  const char* place;
  const char* value;  // JSON; nullptr: the place is removed
  const char* message;
};

// Expects that the file is refused by its name after each of these changes alone.
template <typename Read>
void ExpectEditsRefused(const std::filesystem::path& file, const std::vector<FieldEdit>& edits,
                        const Read& read) {
  const nlohmann::json whole = nlohmann::json::parse(FileBytes(file));
  for (const auto& [place, value, message] : edits) {
    SCOPED_TRACE(testing::Message() << place << ": " << (value == nullptr ? "removed" : value));
    nlohmann::json document = whole;
    const nlohmann::json::json_pointer pointer(place);
    if (value != nullptr) {
      document[pointer] = nlohmann::json::parse(value);
    } else {
      document[pointer.parent_pointer()].erase(pointer.back());
    }
    WriteBytes(file, document.dump());
    ExpectError<InputError>(read, {file.filename().string() + ": ", message});
  }
}

}  // namespace soslam
