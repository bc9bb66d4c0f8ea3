// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <utility>

#include "support/finished_run.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

// A stage and how it is called in folder "chain".
struct Call {
  std::string stage;
  std::string output;
  std::string inputs;
};
const std::string kTable = " --table ../pipelines/priors/semantic_table.json";
const std::vector<Call> kCalls = {
    {"import", "sequence.json", "--dataset ../data/small"},
    {"edges", "edges.h5", "--dataset ../data/small --sequence sequence.json"},
    {"initialise", "initial.json", "--sequence sequence.json" + kTable},
    {"refine", "refined.json",
     "--sequence sequence.json --initial initial.json --edges edges.h5 --curves symmetry.h5" +
         kTable},
    {"optimise", "map.json", "--sequence sequence.json --landmarks refined.json" + kTable}};

// Runs stages one by one, each on what those before it wrote into folder "chain".
class StageChain {
 public:
  StageChain() { fs::create_directory(pipeline_.Folder() / "chain"); }

  const SmallPipeline& pipeline() const { return pipeline_; }
  fs::path Dataset(const std::string& file) const { return pipeline_.Dataset() / file; }
  fs::path Artefact(const std::string& file) const { return pipeline_.Folder() / "chain" / file; }
  static std::string OutputOf(const std::string& stage) {
    return std::ranges::find(kCalls, stage, &Call::stage)->output;
  }

  CommandResult Run(const std::string& stage, const std::string& flags = "--quiet") const {
    const Call& call = *std::ranges::find(kCalls, stage, &Call::stage);
    const std::string command = fmt::format("exec {} {} --threads 2 --output {} {}",
                                            StageProgram(stage), flags, call.output, call.inputs);
    return RunCommand({"env", "-C", Artefact("").string(), "sh", "-c", command});
  }

  // A chain of which all stages ran, once for all tests that ask for it. Each finds it as they left
  // it.
  static const StageChain& Finished() {
    static const StageChain chain;
    static const SavedFolder saved = [] {
      for (const Call& call : kCalls) ExpectSuccess(chain.Run(call.stage));
      return SavedFolder(chain.pipeline().Folder());
    }();
    saved.Restore();
    return chain;
  }

  // Runs all stages before this one; they have to succeed.
  void RunUpTo(const std::string& stage) const {
    for (auto call = kCalls.begin(); call->stage != stage; ++call) ExpectSuccess(Run(call->stage));
  }

 private:
  SmallPipeline pipeline_;
};

// Makes an input of the next stage bad.
using Spoil = std::function<void(const StageChain&)>;
using SpoilFile = std::function<void(const fs::path&)>;

Spoil InDataset(const std::string& file, const SpoilFile& spoil) {
  return [=](const StageChain& chain) { spoil(chain.Dataset(file)); };
}
Spoil InArtefact(const std::string& file, const SpoilFile& spoil) {
  return [=](const StageChain& chain) { spoil(chain.Artefact(file)); };
}

// Replaces the first `from`, which has to be there.
SpoilFile Text(const std::string& from, const std::string& to) {
  return [=](const fs::path& file) {
    std::string bytes = FileBytes(file);
    const size_t found = bytes.find(from);
    ASSERT_NE(found, std::string::npos) << file << " has no " << from;
    WriteBytes(file, bytes.replace(found, from.size(), to));
  };
}

// Replaces a line, counted from 1.
SpoilFile Line(int number, const std::string& line) {
  return [=](const fs::path& file) {
    std::string text = FileBytes(file);
    size_t begin = 0;
    for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
    const size_t end = text.find('\n', begin);
    ASSERT_NE(end, std::string::npos) << file << " has no line " << number;
    WriteBytes(file, text.replace(begin, end - begin, line));
  };
}

SpoilFile Content(const std::string& content) {
  return [=](const fs::path& file) { WriteBytes(file, content); };
}

void Truncate(const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }

void LinkToItself(const fs::path& file) {
  fs::remove_all(file);
  fs::create_symlink(file.filename(), file);
}

// Replaces a file of the dataset by a symbolic link to a file with the same content elsewhere.
Spoil MovedOut(const std::string& file) {
  return [=](const StageChain& chain) {
    const fs::path elsewhere = chain.pipeline().Folder() / "elsewhere";
    fs::rename(chain.Dataset(file), elsewhere);
    fs::create_symlink(elsewhere, chain.Dataset(file));
  };
}

// A semantic table that knows these labels only and has no default.
Spoil TableOf(const std::vector<std::string>& labels) {
  return [=](const StageChain& chain) {
    json table = {{"labels", json::object()}};
    for (const std::string& label : labels) {
      table["labels"][label] = {{"a_by_c", 1.0}, {"b_by_c", 0.5}, {"source", "the test"}};
    }
    WriteBytes(chain.pipeline().SemanticTable(), table.dump());
  };
}

// Puts object 2 on a plane above the camera: rays through the lower edges of its boxes meet that
// plane behind the camera.
void PutObject2OnACeiling(const StageChain& chain) {
  json planes = json::parse(FileBytes(chain.Dataset("planes.json")));
  planes.push_back({{"id", 1}, {"label", "ceiling"}, {"normal", {0, 0, 1}}, {"d", -5}});
  WriteBytes(chain.Dataset("planes.json"), planes.dump());
  json objects = json::parse(FileBytes(chain.Dataset("objects.json")));
  objects[1]["support_plane"] = 1;
  WriteBytes(chain.Dataset("objects.json"), objects.dump());
}

std::set<fs::path> NamesIn(const fs::path& folder) {
  std::set<fs::path> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

// One line that a terminal takes for text, and a person can read.
void ExpectOneLine(const std::string& errors) {
  constexpr size_t kMaxLength = 2500;
  EXPECT_LE(errors.size(), kMaxLength);
  ASSERT_FALSE(errors.empty());
  EXPECT_EQ(errors.back(), '\n');
  EXPECT_TRUE(std::all_of(errors.begin(), errors.end() - 1, [](unsigned char character) {
    return character >= 0x20 && character != 0x7F;
  })) << errors;
}

struct RefusedInput {
  std::string name;
  std::string stage;  // that meets it, after all stages ran on the sound dataset
  Spoil spoil;
  std::vector<std::string> words;  // of the error: the file, what was found
  int exit_code;
};

RefusedInput Refused(std::string name, std::string stage, Spoil spoil,
                     std::vector<std::string> words, int exit_code = 3) {
  return {std::move(name), std::move(stage), std::move(spoil), std::move(words), exit_code};
}

void PrintTo(const RefusedInput& input, std::ostream* stream) { *stream << input.name; }

class RefusedInputTest : public testing::TestWithParam<RefusedInput> {};

// What was written before stays as it was, and nothing but the record of the failure is left beside
// it.
TEST_P(RefusedInputTest, EndsWithItsExitCodeAndOneLineThatNamesIt) {
  const RefusedInput& bad = GetParam();
  const StageChain& chain = StageChain::Finished();
  ASSERT_NO_FATAL_FAILURE(bad.spoil(chain));
  const fs::path output = chain.Artefact(StageChain::OutputOf(bad.stage));
  WriteBytes(output, "from before");
  std::set<fs::path> names = NamesIn(output.parent_path());
  names.insert("run.json");

  const CommandResult result = chain.Run(bad.stage);
  EXPECT_EQ(result.exit_code, bad.exit_code);
  EXPECT_THAT(result.errors, testing::StartsWith("soslam-" + bad.stage + ": error: "));
  ExpectOneLine(result.errors);
  for (const std::string& word : bad.words) EXPECT_THAT(result.errors, HasSubstr(word));
  EXPECT_EQ(FileBytes(output), "from before");
  EXPECT_EQ(NamesIn(output.parent_path()), names);
}

constexpr const char* kDetectionsHeader = "frame,object_id,label,score,x1,y1,x2,y2\n";

const std::vector<RefusedInput> kRefusedInputs = {
    Refused("NoDetectionLeft", "import", InDataset("detections.csv", Content(kDetectionsHeader)),
            {"no usable detection"}, 4),
    Refused("EdgesTruncated", "refine", InArtefact("edges.h5", Truncate), {"edges.h5"}),
    Refused("ArtefactOfAnotherKind", "optimise",
            [](const StageChain& chain) {
              fs::copy_file(chain.Artefact("sequence.json"), chain.Artefact("refined.json"),
                            fs::copy_options::overwrite_existing);
            },
            {"refined.json", "kind", "landmarks"}),
    // Somebody made these to harm.
    Refused("ZeroByte", "import",
            InDataset("detections.csv", Line(3, std::string("0,2,sto\0ol,1,1,1,2,2", 20))),
            {"detections.csv:3", "UTF-8"}),
    Refused("EscapeSequence", "import",
            InDataset("detections.csv", Line(3, "\x1b[2J,2,stool,1,1,1,2,2")),
            {"detections.csv:3", "frame is '\\x1b[2J'"}),
    Refused("AMillionDigits", "import",
            InDataset("odometry.txt", Line(3, std::string(1000000, '1') + "e 0 0 1 0 0 0 1")),
            {"odometry.txt:3", "timestamp is '11", " ... ", "expected a finite number"}),
    Refused("LinkToItself", "import", InDataset("camera.json", LinkToItself),
            {"camera.json is missing"}),
    Refused("ZeroByteInLabel", "import",
            InDataset("objects.json", Text("\"stool\"", "\"sto\\u0000ol\"")),
            {"objects.json", "zero byte"}),
    Refused("ImageBeyondMemory", "import",
            InDataset("camera.json", Text("\"width\":", "\"width\": 2000000000, \"source\":")),
            {"camera.json", "pixels in all"}),
    Refused("CameraBeyondMemory", "edges",
            InArtefact("sequence.json", Text("\"width\": 480", "\"width\": 2000000000")),
            {"sequence.json", "2000000000 x 360"}),
    Refused("LinkLeadsOut", "import", MovedOut("rgb/000001.png"),
            {"rgb.txt", "rgb/000001.png", "--allow_outside_paths"}),
    Refused("NameInSequenceLeadsOut", "edges",
            InArtefact("sequence.json", Text("rgb/000001.png", "../secret.png")),
            {"sequence.json", "../secret.png", "outside"})};

INSTANTIATE_TEST_SUITE_P(Stages, RefusedInputTest, testing::ValuesIn(kRefusedInputs),
                         [](const auto& info) { return info.param.name; });

TEST(UnusualInputTest, ImagesElsewhereAreReadWhenTheUserSaysSo) {
  const StageChain chain;
  chain.RunUpTo("edges");
  MovedOut("rgb")(chain);
  ExpectSuccess(chain.Run("edges", "--quiet --allow_outside_paths"));
}

TEST(UnusualInputTest, WhatCannotBeInitialisedIsCountedWithItsReason) {
  for (const auto& [spoil, reason] :
       {std::pair(TableOf({"chest", "armchair"}), "no_ratio_for_label"),
        std::pair(Spoil(PutObject2OnACeiling), "support_plane_not_in_view")}) {
    SCOPED_TRACE(reason);
    const StageChain& chain = StageChain::Finished();
    spoil(chain);
    chain.RunUpTo("initialise");
    const CommandResult result = ExpectExit(0, chain.Run("initialise"));
    EXPECT_LE(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    const json landmarks = json::parse(FileBytes(chain.Artefact("initial.json")));
    EXPECT_EQ(landmarks.at("failures").value(reason, 0), SmallPipeline::kFrames);
  }
}

TEST(UnusableInputTest, NoLabelInTheTable) {
  const StageChain& chain = StageChain::Finished();
  TableOf({"sofa"})(chain);
  EXPECT_THAT(ExpectExit(4, chain.Run("initialise")).errors,
              HasSubstr("12 of a label that the semantic table does not have"));
}

}  // namespace
}  // namespace soslam
