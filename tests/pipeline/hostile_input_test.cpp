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

Spoil TableContent(const std::string& content) {
  return [=](const StageChain& chain) { WriteBytes(chain.pipeline().SemanticTable(), content); };
}

std::string Nested(int levels) { return std::string(static_cast<size_t>(levels), '['); }

// The signature and first chunk of a PNG image of this size (4 bytes, big endian), and its end.
std::string PngThatClaims(const std::string& side) {
  return std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + side + side +
         std::string("\x08\0\0\0\0\0\0\0\0IEND\xae\x42\x60\x82", 17);
}

// Replaces a file of the dataset by a symbolic link to a file with the same content elsewhere.
Spoil MovedOut(const std::string& file) {
  return [=](const StageChain& chain) {
    const fs::path elsewhere = chain.pipeline().Folder() / "elsewhere";
    fs::rename(chain.Dataset(file), elsewhere);
    fs::create_symlink(elsewhere, chain.Dataset(file));
  };
}

void WithNegativeAxis(const StageChain& chain) {
  const fs::path file = chain.Artefact("refined.json");
  nlohmann::json document = nlohmann::json::parse(FileBytes(file));
  document["observations"][0]["hypotheses"][0]["landmark"]["half_axes"][0] = -0.5;
  WriteBytes(file, document.dump());
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
                {"camera.json is missing"}),
        Refused("FolderThatIsALinkToItself", "edges", ToDataset("rgb", LinkToItself),
                {"rgb/000000.png"}),
        Refused("ListIsAnImage", "import",
                [](const StageChain& chain) {
                  fs::copy_file(chain.Dataset("rgb/000000.png"), chain.Dataset("rgb.txt"),
                                fs::copy_options::overwrite_existing);
                },
                {"rgb.txt:1", "UTF-8"})),
    CaseName<RefusedInput>);

INSTANTIATE_TEST_SUITE_P(
    Json, HostileInputTest,
    testing::Values(
        Refused("NestedDataset", "import", Content("objects.json", Nested(1000000)),
                {"objects.json", "more than 100"}),
        Refused("NestedArtefact", "initialise", ArtefactContent("sequence.json", Nested(1000000)),
                {"sequence.json", "more than 100"}),
        Refused("NestedTable", "initialise", TableContent(R"({"labels": )" + Nested(1000000)),
                {"semantic_table.json", "more than 100"}),
        Refused("ZeroByteInLabel", "import",
                DatasetText("objects.json", "\"stool\"", "\"sto\\u0000ol\""),
                {"objects.json", "zero byte"}),
        Refused("ImageBeyondMemory", "import",
                DatasetText("camera.json", "\"width\":", "\"width\": 2000000000, \"source\":"),
                {"camera.json", "pixels in all"}),
        Refused("CameraBeyondMemory", "edges",
                ArtefactText("sequence.json", "\"width\": 480", "\"width\": 2000000000"),
                {"sequence.json", "2000000000 x 360"}),
        Refused("IdBeyondTheSequence", "optimise",
                ArtefactText("refined.json", "\"frame\": 0", "\"frame\": 2147483647"),
                {"refined.json", "2147483647"}),
        Refused("LandmarkOfNoSize", "optimise", WithNegativeAxis, {"refined.json", "half_axes"}),
        Refused("EdgesAreText", "refine",
                ArtefactContent("edges.h5", "\x89HDF\r\n\x1a\n is all that is right"),
                {"edges.h5", "HDF5"})),
    CaseName<RefusedInput>);

INSTANTIATE_TEST_SUITE_P(
    Image, HostileInputTest,
    testing::Values(Refused("ClaimsAbsurdSize", "edges",
                            Content("rgb/000001.png", PngThatClaims({0, 0, '\xff', '\xff'})),
                            {"rgb/000001.png", "65535 x 65535"}),
                    Refused("IsText", "edges", Content("rgb/000001.png", "hello"),
                            {"rgb/000001.png", "JPEG, PNG"}),
                    Refused("IsAFolder", "edges", ToDataset("rgb/000001.png", PutFolderInPlaceOf),
                            {"rgb/000001.png"}),
                    Refused("NameLeadsOut", "import",
                            DatasetText("rgb.txt", "rgb/000001.png",
                                        "../small/rgb/../../secret.png"),
                            {"rgb.txt", "secret.png", "outside"}),
                    Refused("NameIsAbsolute", "import",
                            DatasetText("rgb.txt", "rgb/000001.png", "/etc/hostname"),
                            {"rgb.txt", "/etc/hostname", "outside"}),
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
