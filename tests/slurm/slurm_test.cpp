// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "support/eventually.h"
#include "support/run_command.h"
#include "support/small_pipeline.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// Two nodes with one CPU each on this machine, by tests/slurm/cluster, until the end of the object.
class SlurmCluster {
 public:
  SlurmCluster() {
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "setpriv"}) {
      const CommandResult found = RunCommand({"env", kPath, "which", program});
      if (found.exit_code != 0) problem_ = std::string("there is no ") + program;
    }
    if (!problem_.empty()) return;
    const std::string ready = (folder_ / "ready").string();
    daemons_ = std::make_unique<BackgroundCommand>(std::vector<std::string>{
        "setpriv", "--pdeathsig", "TERM", SOSLAM_SOURCE_DIR "/tests/slurm/cluster",
        (folder_ / "cluster").string(), "sh", "-c", "touch " + ready + "; exec sleep infinity"});
    if (Eventually([&] { return std::filesystem::exists(ready); })) return;
    daemons_->KillAll();
    problem_ = "Slurm does not come up: " + daemons_->Wait().errors;
    daemons_.reset();
  }
  ~SlurmCluster() {
    if (!daemons_) return;
    Run({"scancel", "--me"});
    Eventually([&] { return Queue().empty(); }, std::chrono::seconds(20));
  }
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  // Why there is none; empty: there is one.
  const std::string& problem() const { return problem_; }

  // Runs a program that finds the cluster.
  CommandResult Run(std::vector<std::string> words) const {
    const std::vector<std::string> environment = {
        "env", kPath, "SLURM_CONF=" + (folder_ / "cluster/slurm.conf").string()};
    words.insert(words.begin(), environment.begin(), environment.end());
    return RunCommand(words);
  }

  // A line "<dataset> <element of the array> <state>" for each job.
  std::vector<std::string> Queue() const {
    std::istringstream lines(Run({"squeue", "--array", "--noheader", "--format=%j %K %T"}).output);
    std::vector<std::string> jobs;
    for (std::string line; std::getline(lines, line);) jobs.push_back(line);
    return jobs;
  }

 private:
  // Daemons are where an ordinary user's PATH does not lead.
  static constexpr const char* kPath = "PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin";

  TemporaryFolder folder_;
  std::string problem_;
  std::unique_ptr<BackgroundCommand> daemons_;
};

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// Results. Records list files in the order of their paths, so both come after the data.
constexpr const char* kCluster = "results-of-the-cluster";
constexpr const char* kLocal = "results-of-make";

// A sweep of the small scene with two seeds of its noise through a trunk and two branches.
class SlowSlurmTest : public testing::Test {
 protected:
  void SetUp() override {
    if (cluster_.problem().empty()) return;
    const char* slurm = std::getenv("SOSLAM_SLURM");
    if (slurm != nullptr && slurm == std::string("required")) FAIL() << cluster_.problem();
    GTEST_SKIP() << "needs Slurm: " << cluster_.problem();
  }

  SlowSlurmTest() {
    nlohmann::json scene = SmallScene(3);
    scene["noise"] = {{"box_edge_sigma", 0.01}, {"image_sigma", 1.0}};
    WriteBytes(Scene(), scene.dump());
    fs::create_directory(folder_ / "programs");
    for (const auto& entry : fs::directory_iterator(SOSLAM_BINARY_DIR)) {
      fs::create_symlink(entry.path(), folder_ / "programs" / entry.path().filename());
    }
  }

  fs::path Scene() const { return folder_ / "small.json"; }
  fs::path Data() const { return folder_ / "data"; }
  fs::path Results(const std::string& name) const { return folder_ / name; }

  CommandResult Make(const std::string& goal, const std::string& results,
                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {
        "-j2",
        "-C",
        SOSLAM_SOURCE_DIR,
        goal,
        "SCENES=" + Scene().string(),
        "SEEDS=1 2",
        "VARIANT=InitP OursP InitPT OursPT",
        "BUILD=" + fs::path(SOSLAM_BINARY_DIR).parent_path().string(),
        "BIN=" + (folder_ / "programs").string(),
        "DATA_ROOT=" + Data().string(),
        "RESULTS=" + Results(results).string(),
    };
    words.insert(words.end(), more.begin(), more.end());
    return cluster_.Run(MakeWords(words));
  }
  void Do(const std::string& goal, const std::string& results,
          const std::vector<std::string>& more = {}) const {
    ExpectSuccess(Make(goal, results, more));
  }
  void Submit() const { Do("submit", kCluster); }
  std::string Status(const std::vector<std::string>& more = {}) const {
    return ExpectSuccess(Make("status", kCluster, more));
  }
  void WaitForTheQueue() const {
    ASSERT_TRUE(Eventually([&] { return cluster_.Queue().empty(); }))
        << testing::PrintToString(cluster_.Queue());
  }
  // From now on a stage takes some seconds longer, or fails.
  void Replace(const std::string& stage, const std::string& script) const {
    const fs::path program = folder_ / "programs" / ("soslam-" + stage);
    fs::remove(program);
    WriteBytes(program, "#!/bin/sh\n" + script + "\nexec " + StageProgram(stage) + " \"$@\"\n");
    fs::permissions(program, fs::perms::owner_all);
  }
  bool SomeJobIs(const std::string& pattern) const {
    for (const std::string& job : cluster_.Queue()) {
      if (std::regex_match(job, std::regex(pattern))) return true;
    }
    return false;
  }

  // What tells runs of the same thing apart is in the timing only.
  static std::map<std::string, nlohmann::json> Records(const fs::path& results) {
    std::map<std::string, nlohmann::json> records;
    for (const auto& entry : fs::recursive_directory_iterator(results)) {
      if (entry.path().filename() != "run.json") continue;
      nlohmann::json record = nlohmann::json::parse(FileBytes(entry.path()));
      record.erase("timing");
      records[entry.path().lexically_relative(results).string()] = record;
    }
    return records;
  }
  void ExpectTheBytesOfALocalRun() const {
    Do("sweep", kLocal);
    const auto local = SmallPipeline::Artefacts(Results(kLocal));
    EXPECT_EQ(local.count("small-seed2/OursPT/metrics.json"), 1u);
    EXPECT_NE(local.at("small-seed1/OursPT/map.json"), local.at("small-seed2/OursPT/map.json"));
    EXPECT_THAT(Differing(SmallPipeline::Artefacts(Results(kCluster)), local), IsEmpty());
    EXPECT_THAT(Differing(Records(Results(kCluster)), Records(Results(kLocal))), IsEmpty());
  }
  void ExpectAllDone() const {
    const std::string status = Status();
    EXPECT_THAT(status, ContainsRegex("OursP +done +- +done +- +done +done"));
    EXPECT_THAT(status, ContainsRegex("OursPT +done +done +done +done +done +done"));
    EXPECT_THAT(status, Not(ContainsRegex("queued|running|missing|stale|failed")));
  }

  void ExpectTheSweepToEndWithTheBytesOfALocalRun() const {
    WaitForTheQueue();
    ExpectAllDone();
    ExpectTheBytesOfALocalRun();
  }

  TemporaryFolder folder_;
  SlurmCluster cluster_;
};

TEST_F(SlowSlurmTest, StagesThroughSrunGiveTheSameBytes) {
  Do("sweep", kCluster, {"LAUNCH=srun --ntasks=1 --input=none --job-name=\"two words\""});
  ExpectTheBytesOfALocalRun();
}

TEST_F(SlowSlurmTest, ASweepGivesTheBytesOfALocalOne) {
  Submit();
  ExpectTheSweepToEndWithTheBytesOfALocalRun();
  Submit();
  EXPECT_THAT(cluster_.Queue(), IsEmpty()) << "nothing is out of date";
}

TEST_F(SlowSlurmTest, StatusFollowsTheQueue) {
  Replace("optimise", "sleep 5");
  const auto set_nodes = [&](const std::string& state) {
    const CommandResult set =
        cluster_.Run({"scontrol", "update", "NodeName=node[1-2]", "State=" + state, "Reason=test"});
    ASSERT_EQ(set.exit_code, 0) << set.errors;
  };
  set_nodes("DRAIN");
  Submit();
  EXPECT_THAT(cluster_.Queue(), SizeIs(6));
  EXPECT_THAT(Status(), ContainsRegex("OursPT +queued +queued +queued +queued +queued +queued"));
  EXPECT_THAT(Status({"VARIANT=SVD"}), ContainsRegex("SVD +queued +missing +missing"))
      << "its import is that of others";
  Submit();
  EXPECT_THAT(cluster_.Queue(), SizeIs(6)) << "they are in the queue already";
  set_nodes("RESUME");
  EXPECT_TRUE(Eventually([&] {
    return testing::Value(Status(), ContainsRegex("OursP +done +- +done +- +running +queued"));
  }));
  WaitForTheQueue();
  ExpectAllDone();
}

TEST_F(SlowSlurmTest, WhatWasCancelledOnTheWayIsResumed) {
  Replace("optimise", "sleep 3");
  Submit();
  ASSERT_TRUE(Eventually([&] { return SomeJobIs("small-seed1 [12] RUNNING"); }));
  cluster_.Run({"scancel", "--me"});
  WaitForTheQueue();
  // What a job started may be there a little longer than the job.
  EXPECT_TRUE(
      Eventually([&] { return testing::Value(Status(), Not(ContainsRegex("queued|running"))); }));
  EXPECT_THAT(Status(), ContainsRegex("missing|failed"));
  EXPECT_THAT(Status(), ContainsRegex("InitP +done +- +done +- +- +done"));
  Submit();
  EXPECT_FALSE(SomeJobIs("small-seed1 0 .*")) << "the trunk was done";
  ExpectTheSweepToEndWithTheBytesOfALocalRun();
}

TEST_F(SlowSlurmTest, JobsOfANodeThatFailsRunOnAnother) {
  Replace("optimise", "sleep 3");
  Submit();
  ASSERT_TRUE(Eventually([&] { return SomeJobIs("small-seed1 [12] RUNNING"); }));
  const auto set_node = [&](const std::string& state) {
    return cluster_.Run({"scontrol", "update", "NodeName=node1", "State=" + state, "Reason=test"});
  };
  EXPECT_EQ(set_node("DOWN").exit_code, 0);
  ExpectTheSweepToEndWithTheBytesOfALocalRun();
}

TEST_F(SlowSlurmTest, FailuresAreShownAndTheRestIsDone) {
  Do("scenes", kCluster);
  const fs::path image = Data() / "small-seed1/rgb/000002.png";
  const std::string whole_image = FileBytes(image);
  WriteBytes(image, whole_image.substr(0, whole_image.size() / 2));
  Submit();
  WaitForTheQueue();
  const std::string status = Status();
  EXPECT_THAT(status, ContainsRegex("edges-[0-9a-f]+: its last run failed: exit code 3: .*000002"));
  EXPECT_THAT(status, ContainsRegex("OursPT +done +failed +done +missing +missing +missing"));
  EXPECT_THAT(status, ContainsRegex("OursP +done +- +done +- +done +done"));
  EXPECT_THAT(status, ContainsRegex("OursPT +done +done +done +done +done +done")) << "seed 2";
  WriteBytes(image, whole_image);
  Submit();
  ExpectTheSweepToEndWithTheBytesOfALocalRun();
}

}  // namespace
}  // namespace soslam
