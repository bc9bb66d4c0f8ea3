// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "soslam/base/error.h"
#include "soslam/system/hash.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

// Variant One imports data/room and initialises; variant Two does so with other settings.
class VerifyTest : public FolderTest {
 protected:
  VerifyTest() {
    Write("data/room/rgb.txt", "images");
    Write("results/room/shared/dataset.txt", (folder_ / "data/room").string() + "\n");
    Write("results/room/shared/import-0/sequence.json", "sequence");
    WriteRecord("import-0", {"dataset", "dataset", "rgb.txt", Sha256OfText("images")},
                "sequence.json", "sequence");
    for (const std::string id : {"initialise-1", "initialise-2"}) {
      Write("results/room/shared/" + id + "/initial.json", id);
      WriteRecord(
          id, {"sequence", kRelativeToRun, "../import-0/sequence.json", Sha256OfText("sequence")},
          "initial.json", id);
    }
    WriteVariant("One", "initialise-1");
    WriteVariant("Two", "initialise-2");
  }

  void WriteRecord(const std::string& id, const RunFile& input, const std::string& output,
                   const std::string& bytes) const {
    RunRecord record;
    record.stage = "soslam-" + id.substr(0, id.find('-'));
    record.software = ThisSoftware();
    record.settings.emplace();
    record.folders = {{"dataset", folder_ / "data/room"}};
    record.inputs = {input};
    record.outputs = {{"output", kRelativeToRun, output, Sha256OfText(bytes)}};
    record.timing = {{"wall_s", 1.0},
                     {"cpu_s", 1.0},
                     {"peak_memory_mb", 1.0},
                     {"threads", 1},
                     {"machine", {{"cpu", "A CPU"}, {"cores", 1}}}};
    WriteRun(Shared(id) / "run.json", record);
  }
  void WriteVariant(const std::string& name, const std::string& id) const {
    Write("results/room/" + name + "/stages.txt", "import-0\n" + id + "\n");
    fs::create_symlink("../shared/import-0/sequence.json",
                       folder_ / ("results/room/" + name + "/sequence.json"));
    fs::create_symlink("../shared/" + id + "/initial.json",
                       folder_ / ("results/room/" + name + "/initial.json"));
  }
  fs::path Shared(const std::string& id) const { return folder_ / "results/room/shared" / id; }

  DatasetRuns Runs(const fs::path& data_root = {}) const {
    return FindRuns(folder_ / "results", data_root).at(0);
  }
  std::vector<Discrepancy> Findings(const fs::path& data_root = {}) const {
    return Verify(Runs(data_root)).discrepancies;
  }
  static auto Says(const std::string& file, const std::string& what,
                   const std::vector<std::string>& variants) {
    return AllOf(Field(&Discrepancy::text, AllOf(HasSubstr(file), HasSubstr(what))),
                 Field(&Discrepancy::variants, variants));
  }
};

TEST_F(VerifyTest, FindsRunsInTheirOrderWithTheirVariants) {
  fs::create_directories(Shared("refine-9"));
  const DatasetRuns runs = Runs();
  ASSERT_EQ(runs.runs.size(), 3u);
  EXPECT_EQ(runs.runs[0].name, "shared/import-0");
  EXPECT_THAT(runs.runs[0].variants, ElementsAre("One", "Two"));
  EXPECT_THAT(runs.runs[2].variants, ElementsAre("Two"));
  EXPECT_THAT(runs.unused, ElementsAre("shared/refine-9"));
  EXPECT_EQ(runs.dataset, folder_ / "data/room");
}

TEST_F(VerifyTest, ChangedArtefactConcernsItsMakerAndItsReaders) {
  Write("results/room/shared/import-0/sequence.json", "Sequence");
  EXPECT_THAT(
      Findings(),
      ElementsAre(
          Says("sequence.json", "has changed since shared/import-0 wrote it", {"One", "Two"}),
          Says("sequence.json", "has changed since shared/initialise-1 read it", {"One"}),
          Says("sequence.json", "has changed since shared/initialise-2 read it", {"Two"})));
}

TEST_F(VerifyTest, ArtefactAndDatasetFileAreGone) {
  fs::remove(Shared("initialise-2") / "initial.json");
  fs::remove(folder_ / "data/room/rgb.txt");
  EXPECT_THAT(
      Findings(),
      ElementsAre(
          Says("data/room/rgb.txt", "is gone since shared/import-0 read it", {"One", "Two"}),
          Says("initial.json", "is gone since shared/initialise-2 wrote it", {"Two"}),
          Says("Two/initial.json", "is gone; expected that of shared/initialise-2", {"Two"})));
}

TEST_F(VerifyTest, ADatasetThatIsNotThereIsOneFindingAndMayHaveMoved) {
  fs::create_directory(folder_ / "elsewhere");
  fs::rename(folder_ / "data/room", folder_ / "elsewhere/room");
  EXPECT_THAT(Findings(), ElementsAre(Says("data/room", "is not there", {"One", "Two"})));
  EXPECT_THAT(Findings(folder_ / "elsewhere"), IsEmpty());
}

TEST_F(VerifyTest, MovedResultsAreStillWell) {
  fs::create_directory(folder_ / "elsewhere");
  fs::rename(folder_ / "results", folder_ / "elsewhere/of another name");
  EXPECT_THAT(Verify(FindRuns(folder_ / "elsewhere/of another name", {}).at(0)).discrepancies,
              IsEmpty());
}

TEST_F(VerifyTest, RecordIsMissingOrDamagedOrWithoutOutputs) {
  RunRecord record = ReadRun(Shared("initialise-2") / "run.json");
  record.outputs.clear();
  WriteRun(Shared("initialise-2") / "run.json", record);
  EXPECT_THAT(Findings(), ElementsAre(Says("initialise-2/run.json", "has no outputs", {"Two"})));
  fs::remove(Shared("initialise-1") / "run.json");
  WriteBytes(Shared("initialise-2") / "run.json", "{}");
  EXPECT_THAT(Findings(),
              ElementsAre(Says("initialise-1/run.json", "is missing", {"One"}),
                          Says("initialise-2/run.json", "no artefact header", {"Two"})));
}

// A stage that crashes leaves the record of the run before; make writes down that it failed.
TEST_F(VerifyTest, FailureAndCrash) {
  WriteBytes(Shared("initialise-2") / "failed", "exit code 139\n");
  EXPECT_THAT(Findings(), ElementsAre(Says("initialise-2", "failed: exit code 139", {"Two"})));
  RunRecord record = ReadRun(Shared("initialise-1") / "run.json");
  record.exit_code = 5;
  record.error = "no solution";
  WriteRun(Shared("initialise-1") / "run.json", record);
  EXPECT_THAT(Findings(), ElementsAre(Says("initialise-1", "failed: no solution", {"One"}),
                                      Says("initialise-2", "exit code 139", {"Two"})));
}

TEST_F(VerifyTest, AVariantThatShowsOtherFilesThanItsRunsMade) {
  fs::remove(folder_ / "results/room/Two/initial.json");
  Write("results/room/Two/initial.json", "initialise-2");
  Write("results/room/Two/metrics.json", "of somebody");
  EXPECT_THAT(
      Findings(),
      ElementsAre(Says("Two/initial.json", "is not the one of shared/initialise-2", {"Two"}),
                  Says("Two/metrics.json", "no run of the variant wrote it", {"Two"})));
}

// Relative paths begin where the stage was called, not where they are verified.
TEST_F(VerifyTest, PathsBeginInTheFolderOfTheCall) {
  Write("call/table.json", "table");
  RunRecord record = ReadRun(Shared("initialise-2") / "run.json");
  record.called_in = folder_ / "call";
  record.inputs.push_back({"table", kRelativeToCall, "table.json", Sha256OfText("table")});
  WriteRun(Shared("initialise-2") / "run.json", record);
  EXPECT_THAT(Findings(), IsEmpty());
  Write("call/table.json", "another");
  EXPECT_THAT(Findings(), ElementsAre(Says("call/table.json", "has changed", {"Two"})));
}

TEST_F(VerifyTest, ADamagedListOfRunsConcernsItsVariantOnly) {
  Write("results/room/Two/stages.txt", "../../elsewhere\n");
  WriteBytes(Shared("initialise-1") / "initial.json", "other");
  EXPECT_THAT(Findings(), ElementsAre(Says("initial.json", "has changed", {"One"}),
                                      Says("stages.txt", "'../../elsewhere'", {"Two"})));
}

TEST_F(VerifyTest, NothingToVerify) {
  ExpectError<InputError>([&] { FindRuns(folder_ / "missing", {}); }, {"missing"});
  ExpectError<NothingUsableError>([&] { FindRuns(folder_ / "data", {}); }, {"data", "stages.txt"});
}

TEST(RunProgramTest, ReturnsTheExitCodeAndWritesDownWhatIsPrinted) {
  const TemporaryFolder folder;
  const std::filesystem::path printed = folder / "it's printed";
  EXPECT_EQ(RunProgram({"printf", "%s|", "a b", "it's", "$HOME"}, printed), 0);
  EXPECT_EQ(FileBytes(printed), "a b|it's|$HOME|");
  EXPECT_EQ(RunProgram({"sh", "-c", "echo oh >&2; exit 3"}, printed), 3);
  EXPECT_EQ(FileBytes(printed), "oh\n");
  EXPECT_EQ(RunProgram({"sh", "-c", "kill -SEGV $$"}, printed), 128 + SIGSEGV);
  EXPECT_EQ(RunProgram({(folder / "missing").string()}, printed), 127);
}

}  // namespace
}  // namespace soslam
