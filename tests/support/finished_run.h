// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/run_command.h"
#include "support/small_pipeline.h"
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

// The small pipeline after a run of some variants, which takes place once. Each test that asks for
// it finds all files, with their times, as that run left them.
class FinishedRun {
 public:
  explicit FinishedRun(const std::string& variants)
      : output_(ExpectSuccess(pipeline_.Run(variants))), saved_(pipeline_.Folder()) {}

  // What the run printed.
  const std::string& Output() const { return output_; }

  const SmallPipeline& Restored() const {
    saved_.Restore();
    return pipeline_;
  }

 private:
  SmallPipeline pipeline_;
  std::string output_;
  SavedFolder saved_;
};

// Tests of what two variants of single frames left, which are run once for all of them.
class FinishedRunTest : public testing::Test {
 protected:
  static constexpr const char* kVariants = "InitP InitPT";

  static const SmallPipeline& Finished() {
    static const FinishedRun run(kVariants);
    return run.Restored();
  }

  const SmallPipeline& pipeline_ = Finished();
};

}  // namespace soslam
