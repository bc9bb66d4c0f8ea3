// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/run_file.h"

#include <gtest/gtest.h>

#include <opencv2/core/version.hpp>

#include "artefact/json_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

RunRecord SmallRecord() {
  RunRecord record;
  record.stage = "soslam-planes";
  record.software = ThisSoftware();
  record.settings = {{"count", {3, "default"}}, {"name", {"x", "command line"}}};
  record.allow_outside_paths = true;
  record.seed = 7;
  record.folders = {{"dataset", "data/room"}};
  record.inputs = {{"dataset", "dataset", "rgb/1.png", Sha256OfText("1")},
                   {"sequence", kRelativeToRun, "../import-1/sequence.json", Sha256OfText("2")},
                   {"", kRelativeToCall, "elsewhere.txt", Sha256OfText("3")}};
  record.outputs = {{"output", kRelativeToRun, "planes.json", Sha256OfText("4")}};
  record.timing = {{"wall_s", 1.5},
                   {"cpu_s", 2.5},
                   {"peak_memory_mb", 10.0},
                   {"threads", 2},
                   {"machine", {{"cpu", "A CPU"}, {"cores", 4}}}};
  return record;
}

class RunFileTest : public testing::Test {
 protected:
  // Reads the small record after a change of its JSON.
  RunRecord ReadChanged(const std::function<void(json*)>& change) const {
    WriteRun(file_, SmallRecord());
    json document = ParseJsonFile(file_);
    change(&document);
    WriteBytes(file_, document.dump());
    return ReadRun(file_);
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "run.json";
};

TEST_F(RunFileTest, ReadsWhatWasWritten) {
  WriteRun(file_, SmallRecord());
  const std::string bytes = FileBytes(file_);
  const RunRecord record = ReadRun(file_);
  EXPECT_EQ(record.stage, "soslam-planes");
  EXPECT_EQ(record.software, ThisSoftware());
  EXPECT_EQ(record.settings->at("count").value, 3);
  EXPECT_EQ(record.settings->at("name").origin, "command line");
  EXPECT_TRUE(record.allow_outside_paths);
  EXPECT_EQ(record.inputs.at(1).path, "../import-1/sequence.json");
  WriteRun(file_, record);
  EXPECT_EQ(FileBytes(file_), bytes);
}

TEST_F(RunFileTest, KeepsAFailure) {
  RunRecord record = SmallRecord();
  record.settings.reset();
  record.seed.reset();
  record.outputs.clear();
  record.exit_code = 2;
  record.error = "settings.json: \xff is not a number";
  WriteRun(file_, record);
  const RunRecord read = ReadRun(file_);
  EXPECT_FALSE(read.settings);
  EXPECT_FALSE(read.seed);
  EXPECT_EQ(read.exit_code, 2);
  EXPECT_EQ(read.error, "settings.json: \xef\xbf\xbd is not a number");
}

TEST_F(RunFileTest, RefusesDamagedRecordsByName) {
  const std::vector<std::pair<std::function<void(json*)>, std::string>> cases = {
      {[](json* run) { run->erase("inputs"); }, "inputs"},
      {[](json* run) { (*run)["inputs"][0]["sha256"] = "ABC"; }, "/inputs/0/sha256"},
      {[](json* run) { (*run)["inputs"][0]["relative_to"] = "nowhere"; }, "/inputs/0/relative_to"},
      {[](json* run) { (*run)["outputs"][0]["relative_to"] = "table"; }, "/outputs/0/relative_to"},
      {[](json* run) { (*run)["settings"]["count"]["origin"] = "fate"; }, "/settings/count/origin"},
      {[](json* run) { (*run)["exit_code"] = -1; }, "exit_code"},
      {[](json* run) { (*run)["stage"] = "rm -r"; }, "stage"},
      {[](json* run) { (*run)["artefact"]["kind"] = "map"; }, "expected \"run\""},
      {[](json* run) {
         (*run)["artefact"]["schema_version"] = {9, 0};
       },
       "version [9, 0]"}};
  for (const auto& [change, word] : cases) {
    ExpectError<InputError>([&, &change = change] { ReadChanged(change); }, {"run.json", word});
  }
  WriteBytes(file_, "{");
  ExpectError<InputError>([&] { ReadRun(file_); }, {"run.json"});
}

TEST(SoftwareTest, NamesVersions) {
  const Software software = ThisSoftware();
  EXPECT_THAT(software.version, testing::StartsWith("soslam "));
  EXPECT_THAT(software.compiler, testing::ContainsRegex("^(GCC|Clang) [0-9]+\\."));
  EXPECT_EQ(software.libraries.at("opencv"), CV_VERSION);
  for (const char* name : {"ceres", "eigen", "fmt", "hdf5", "nlohmann_json", "openssl"}) {
    EXPECT_THAT(software.libraries.at(name), testing::ContainsRegex("^[0-9]+\\.[0-9]+")) << name;
  }
}

}  // namespace
}  // namespace soslam
