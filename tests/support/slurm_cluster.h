// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "support/background_command.h"
#include "support/eventually.h"
#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {

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

}  // namespace soslam
