// SPDX-License-Identifier: BSD-3-Clause
// Inputs that somebody made to harm: the table of bad inputs goes on.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/refused_input.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

Spoil ArtefactContent(const std::string& file, const std::string& content) {
  return [=](const StageChain& chain) { WriteBytes(chain.Artefact(file), content); };
}

std::string Nested(int levels) { return std::string(static_cast<size_t>(levels), '['); }

// Replaces a file of the dataset by a symbolic link to a file with the same content elsewhere.
Spoil MovedOut(const std::string& file) {
  return [=](const StageChain& chain) {
    const fs::path elsewhere = chain.pipeline().Folder() / "elsewhere";
    fs::rename(chain.Dataset(file), elsewhere);
    fs::create_symlink(elsewhere, chain.Dataset(file));
  };
}

void LinkToItself(const fs::path& file) {
  fs::remove_all(file);
  fs::create_symlink(file.filename(), file);
}

void PutFolderInPlaceOf(const fs::path& file) {
  fs::remove(file);
  fs::create_directory(file);
}

class HostileInputTest : public testing::TestWithParam<RefusedInput> {};

TEST_P(HostileInputTest, EndsWithItsExitCodeAndOneLineThatNamesIt) { ExpectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Text, HostileInputTest,
    testing::Values(
        Refused("ZeroByte", "import",
                Line("detections.csv", 3, std::string("0,2,sto\0ol,1,1,1,2,2", 20)),
                {"detections.csv:3", "UTF-8"}),
        Refused("EscapeSequence", "import", Line("detections.csv", 3, "\x1b[2J,2,stool,1,1,1,2,2"),
                {"detections.csv:3", "frame is '\\x1b[2J'"}),
        Refused("AMillionDigits", "import",
                Line("odometry.txt", 3, std::string(1000000, '1') + "e 0 0 1 0 0 0 1"),
                {"odometry.txt:3", "timestamp is '11", " ... ", "expected a finite number"}),
        Refused("FolderForFile", "import", ToDataset("detections.csv", PutFolderInPlaceOf),
                {"detections.csv", "cannot be read"}),
        Refused("LinkToItself", "import", ToDataset("camera.json", LinkToItself),
                {"camera.json is missing"})),
    CaseName<RefusedInput>);

INSTANTIATE_TEST_SUITE_P(
    Json, HostileInputTest,
    testing::Values(
        Refused("NestedArtefact", "initialise", ArtefactContent("sequence.json", Nested(1000000)),
                {"sequence.json", "more than 100"}),
        Refused("ZeroByteInLabel", "import",
                DatasetText("objects.json", "\"stool\"", "\"sto\\u0000ol\""),
                {"objects.json", "zero byte"}),
        Refused("ImageBeyondMemory", "import",
                DatasetText("camera.json", "\"width\":", "\"width\": 2000000000, \"source\":"),
                {"camera.json", "pixels in all"}),
        Refused("CameraBeyondMemory", "edges",
                ArtefactText("sequence.json", "\"width\": 480", "\"width\": 2000000000"),
                {"sequence.json", "2000000000 x 360"})),
    CaseName<RefusedInput>);

INSTANTIATE_TEST_SUITE_P(
    Image, HostileInputTest,
    testing::Values(Refused("NameLeadsOut", "import",
                            DatasetText("rgb.txt", "rgb/000001.png",
                                        "../small/rgb/../../secret.png"),
                            {"rgb.txt", "secret.png", "outside"}),
                    Refused("LinkLeadsOut", "import", MovedOut("rgb/000001.png"),
                            {"rgb.txt", "rgb/000001.png", "--allow_outside_paths"}),
                    Refused("FolderLeadsOut", "edges", MovedOut("rgb"),
                            {"sequence.json", "rgb/000000.png", "--allow_outside_paths"}),
                    Refused("NameInSequenceLeadsOut", "edges",
                            ArtefactText("sequence.json", "rgb/000001.png", "../secret.png"),
                            {"sequence.json", "../secret.png", "outside"})),
    CaseName<RefusedInput>);

TEST(UnusualInputTest, ImagesElsewhereAreReadWhenTheUserSaysSo) {
  const StageChain chain;
  ASSERT_NO_FATAL_FAILURE(chain.RunUpTo("edges"));
  MovedOut("rgb")(chain);
  const CommandResult result = RunCommand(
      {StageProgram("edges"), "--quiet", "--allow_outside_paths", "--dataset",
       chain.pipeline().Dataset().string(), "--sequence", chain.Artefact("sequence.json").string(),
       "--output", chain.Artefact("edges.h5").string()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

}  // namespace
}  // namespace soslam
