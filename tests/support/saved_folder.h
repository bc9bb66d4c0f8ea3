// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {

// The files of a folder as they were when this was made, with their times.
class SavedFolder {
 public:
  explicit SavedFolder(const std::filesystem::path& folder) : folder_(folder) {
    Copy(folder_, copy_.path());
  }
  void Restore() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      std::filesystem::remove_all(entry.path());
    }
    Copy(copy_.path(), folder_);
  }

 private:
  static void Copy(const std::filesystem::path& from, const std::filesystem::path& to) {
    ExpectSuccess(RunCommand({"cp", "-a", from.string() + "/.", to.string()}));
  }

  std::filesystem::path folder_;
  TemporaryFolder copy_;
};

}  // namespace soslam
