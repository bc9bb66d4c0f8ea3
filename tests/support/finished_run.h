// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "support/saved_folder.h"
#include "support/small_pipeline.h"

namespace soslam {

// The small pipeline after a run of some variants, which takes place once. Each test that asks for
// it finds all files, with their times, as that run left them.
class FinishedRun {
 public:
  explicit FinishedRun(const std::string& variants) : run_(pipeline_.Run(variants)) {
    EXPECT_EQ(run_.exit_code, 0) << run_.errors;
    saved_.emplace(pipeline_.Folder());
  }

  // What the run printed.
  const std::string& Output() const { return run_.output; }

  const SmallPipeline& Restored() const {
    saved_->Restore();
    return pipeline_;
  }

 private:
  SmallPipeline pipeline_;
  CommandResult run_;
  std::optional<SavedFolder> saved_;
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
