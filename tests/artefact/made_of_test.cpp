// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/synthesis/simulate.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/scene.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// An artefact made of results/sequence.json, and a sequence elsewhere.
class MadeOfTest : public FolderTest {
 protected:
  MadeOfTest() {
    WriteSequenceTo(folder_ / "results", {{"border_px", 30.0}, {"min_score", 0.5}});
    WriteLandmarks(landmarks_, {}, sequence_, {{}, {folder_ / "results/sequence.json"}});
  }
  fs::path WriteSequenceTo(const fs::path& folder, const nlohmann::json& settings,
                           const std::string& boxes = "boxes",
                           const std::string& stage = "import") const {
    fs::create_directories(folder);
    const fs::path detections = Write("data/detections.csv", boxes);
    WriteSequence(folder / "sequence.json", sequence_, {settings, {detections}, {}, stage});
    return folder / "sequence.json";
  }
  void ExpectRefused(const fs::path& input, const std::vector<std::string>& words) const {
    ExpectError<InputError>([&] { CheckWasMadeOf(landmarks_, "landmarks", input); }, words);
  }

  Sequence sequence_ = SyntheticSequence(RandomScene(1, 3, 5), false);
  const fs::path landmarks_ = folder_ / "results/initial.json";
};

TEST_F(MadeOfTest, ContentCountsAndNotThePath) {
  fs::copy(folder_ / "results/sequence.json", folder_ / "copy.json");
  EXPECT_NO_THROW(CheckWasMadeOf(landmarks_, "landmarks", folder_ / "copy.json"));
  EXPECT_NO_THROW(CheckWasMadeOf(landmarks_, "landmarks", folder_ / "results/sequence.json"));
  WriteSymmetry(folder_ / "symmetry.h5", {}, {{}, {landmarks_}});
  EXPECT_NO_THROW(CheckWasMadeOf(folder_ / "symmetry.h5", "symmetry", landmarks_));
  ExpectError<InputError>(
      [&] { CheckWasMadeOf(folder_ / "symmetry.h5", "symmetry", folder_ / "copy.json"); },
      {"symmetry.h5: was not made of", "copy.json (SHA-256", "made anew"});
}

TEST_F(MadeOfTest, TheMessageSaysWhatDiffersFromTheFileBeside) {
  const nlohmann::json settings = {{"border_px", 30.0}, {"min_score", 0.5}};
  ExpectRefused(WriteSequenceTo(folder_ / "other", {{"border_px", 0.0}, {"min_score", 0.5}}),
                {"initial.json: was not made of", "other/sequence.json (SHA-256", ", expected ",
                 "has other settings: border_px: 30.0 -> 0.0;",
                 "expected " + (folder_ / "results/sequence.json").string()});
  ExpectRefused(WriteSequenceTo(folder_ / "other", settings, "other boxes"),
                {"was made of another detections.csv"});
  ExpectRefused(WriteSequenceTo(folder_ / "other", settings, "boxes", "planes"),
                {"is of another stage"});
  sequence_.name = "desk";
  ExpectRefused(WriteSequenceTo(folder_ / "other", settings), {"is of desk, not of "});
  ExpectError<InputError>(
      [&] { CheckWasMadeOf(folder_ / "other/sequence.json", "landmarks", landmarks_); },
      {"sequence.json: artefact kind is \"sequence\"; expected \"landmarks\""});
  WriteSequenceTo(folder_ / "results", settings);
  ExpectRefused(folder_ / "results/sequence.json", {"made anew", "run again"});
}

TEST_F(MadeOfTest, AHeaderThatWasEditedIsRefused) {
  for (const char* inputs : {"3", "null", R"(["a"])", R"([{"file": 3, "sha256": 4}])"}) {
    Write("results/initial.json",
          std::string(R"({"artefact": {"kind": "landmarks", "schema_version": [1, 0],
                          "software": "soslam", "settings": {}, "inputs": )") +
              inputs + "}}");
    ExpectRefused(folder_ / "results/sequence.json", {"initial.json: /inputs"});
  }
}

}  // namespace
}  // namespace soslam
