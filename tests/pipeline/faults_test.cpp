// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "support/run_command.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// `make run` of the project itself on the small scene, through all stages that a run can have:
// those of sequences without planes and ids, of bodies of any shape.
class SlowFaultsTest : public testing::Test {
 protected:
  static constexpr int kFrames = 3;

  SlowFaultsTest() {
    const fs::path datasets = pipeline_.Pipelines() / "unannotated/datasets";
    fs::create_directory(datasets);
    // Coarse, for speed.
    WriteBytes(datasets / "small.json",
               R"({"planes": {"refine_poses": false}, "refine": {"yaw_grid_deg": 30},
                   "optimise": {"max_iterations": 3}})");
  }

  std::vector<std::string> Words() const {
    return pipeline_.WordsOfProject(
        {"run", "VARIANT=OursST-unannotated InitS",
         "PIPELINES=" + (pipeline_.Pipelines() / "unannotated").string()});
  }
  CommandResult Run() const { return RunCommand(Words()); }

  // What a run that nothing disturbs leaves behind, by path; removes it again.
  std::map<std::string, std::string> Undisturbed() {
    const auto begin = std::chrono::steady_clock::now();
    ExpectSuccess(Run());
    duration_ = std::chrono::steady_clock::now() - begin;
    auto artefacts = Artefacts();
    EXPECT_EQ(artefacts.count("OursST-unannotated/metrics.json"), 1u);
    fs::remove_all(pipeline_.Results());
    return artefacts;
  }
  std::map<std::string, std::string> Artefacts() const {
    return SmallPipeline::Artefacts(pipeline_.Results());
  }

  // Every artefact that is there is whole.
  void ExpectOnlyPartsOf(const std::map<std::string, std::string>& undisturbed) const {
    if (!fs::exists(pipeline_.Results())) return;
    for (const auto& [path, bytes] : Artefacts()) {
      ASSERT_EQ(undisturbed.count(path), 1u) << path;
      EXPECT_EQ(undisturbed.at(path), bytes) << path;
    }
  }
  void ExpectThatARunGives(const std::map<std::string, std::string>& undisturbed) const {
    ExpectSuccess(Run());
    EXPECT_EQ(Artefacts(), undisturbed);
    for (const auto& entry : fs::recursive_directory_iterator(pipeline_.Results())) {
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    }
  }

  SmallPipeline pipeline_{kFrames};
  std::chrono::duration<double> duration_{};  // of the undisturbed run
};

// How often a run is killed; `SOSLAM_KILLS=200 pipeline_test --gtest_filter=SlowFaultsTest.*` for
// more.
int Kills() {
  const char* const text = std::getenv("SOSLAM_KILLS");
  return text == nullptr ? 2 : std::atoi(text);
}

// Kills everything, or make alone, so that what it started goes on and meets the next run.
TEST_F(SlowFaultsTest, KilledAtAnyMoment) {
  const auto undisturbed = Undisturbed();
  std::mt19937 random(1);
  for (int i = 0; i < Kills() && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    BackgroundCommand run(Words());
    std::this_thread::sleep_for(duration_ * std::uniform_real_distribution<double>(0, 1)(random));
    i % 2 == 0 ? run.KillAll() : run.KillFirst();
    run.Wait();
    ExpectOnlyPartsOf(undisturbed);
    ExpectThatARunGives(undisturbed);
    fs::remove_all(pipeline_.Results());
  }
}

TEST_F(SlowFaultsTest, TwoRunsAtOnce) {
  const auto undisturbed = Undisturbed();
  BackgroundCommand one(Words());
  BackgroundCommand other(Words());
  int stages = 0;  // that ran, in both
  for (BackgroundCommand* run : {&one, &other}) {
    const std::string output = ExpectSuccess(run->Wait());
    for (size_t at = 0; (at = output.find("[small] ", at)) != std::string::npos; ++at) ++stages;
  }
  EXPECT_EQ(stages, std::distance(fs::directory_iterator(pipeline_.Results() / "shared"), {}) - 2)
      << "each stage once: all folders of shared, without the two lists of files";
  EXPECT_EQ(Artefacts(), undisturbed);
  ExpectThatARunGives(undisturbed);
}

// All files are an hour newer than the current time.
TEST_F(SlowFaultsTest, ClockSetBack) {
  ExpectSuccess(Run());
  for (const auto& entry : fs::recursive_directory_iterator(pipeline_.Folder())) {
    if (!entry.is_regular_file() || entry.is_symlink()) continue;
    fs::last_write_time(entry.path(), entry.last_write_time() + std::chrono::hours(1));
  }
  const fs::path camera = pipeline_.Dataset() / "camera.json";
  nlohmann::json changed = nlohmann::json::parse(FileBytes(camera));
  changed["fx"] = 410.0;
  WriteBytes(camera, changed.dump());
  ExpectSuccess(Run());
  const auto after_change = Artefacts();
  fs::remove_all(pipeline_.Results());
  ExpectThatARunGives(after_change);
}

// Results on a file system of their own.
class SlowFaultyDiskTest : public SlowFaultsTest {
 protected:
  ~SlowFaultyDiskTest() override { ::umount(Disk().c_str()); }

  std::string Disk() const { return pipeline_.Results().parent_path().string(); }
  bool Mount(unsigned long flags, const std::string& options) const {
    fs::create_directories(Disk());
    return ::mount("tmpfs", Disk().c_str(), "tmpfs", flags, options.c_str()) == 0;
  }
};

TEST_F(SlowFaultyDiskTest, FullDisk) {
  const auto undisturbed = Undisturbed();
  size_t bytes = 0;
  for (const auto& [path, content] : undisturbed) bytes += content.size();
  if (!Mount(0, "size=256k")) GTEST_SKIP() << "needs root, to mount a small disk";
  // From too little for anything to nearly enough.
  for (const size_t size : {bytes / 64, bytes / 16, bytes / 8, bytes / 5}) {
    SCOPED_TRACE(size);
    ASSERT_TRUE(Mount(MS_REMOUNT, "size=" + std::to_string(size)));
    const CommandResult run = Run();
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output + run.errors, HasSubstr("No space left on device"));
    ExpectOnlyPartsOf(undisturbed);
  }
  ASSERT_TRUE(Mount(MS_REMOUNT, "size=100m"));
  ExpectThatARunGives(undisturbed);
}

TEST_F(SlowFaultyDiskTest, ReadOnlyDisk) {
  if (!Mount(0, "size=100m")) GTEST_SKIP() << "needs root, to mount a disk";
  ExpectSuccess(Run());
  const auto before = Artefacts();
  ASSERT_TRUE(Mount(MS_REMOUNT | MS_RDONLY, ""));
  fs::remove(pipeline_.Dataset() / "objects.json");
  const CommandResult run = Run();
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.output + run.errors, HasSubstr("Read-only file system"));
  EXPECT_THAT(run.output + run.errors, HasSubstr("expected a folder that you may write to"));
  EXPECT_EQ(Artefacts(), before);
}

}  // namespace
}  // namespace soslam
