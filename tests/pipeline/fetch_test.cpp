// SPDX-License-Identifier: BSD-3-Clause
// `make data` and what it calls, over a server and files of the test's own.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "soslam/system/hash.h"
#include "support/http_server.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A publisher of an archive and a list of poses, and an annotation of them.
class FetchTest : public testing::Test {
 protected:
  FetchTest() {
    ::setenv("no_proxy", "127.0.0.1", 1);
    for (const char* name : {"published/top/rgb", "published/top/other", "own/desk", "data"}) {
      fs::create_directories(folder_ / name);
    }
    WriteBytes(folder_ / "published/top/rgb/1.png", "one");
    WriteBytes(folder_ / "published/top/rgb/2.png", "two");
    WriteBytes(folder_ / "published/top/rgb/3.png", "not wanted");
    WriteBytes(folder_ / "published/top/other/1.png", "another one");
    // Bytes that do not pack, so that the archive is large enough to be cut.
    for (unsigned i = 0, random = 1; i < 20000; ++i) {
      noise_ += static_cast<char>((random = random * 1664525U + 1013904223U) >> 24U);
    }
    WriteBytes(folder_ / "published/top/rgb/noise.png", noise_);
    Pack();
    archive_ = FileBytes(folder_ / "desk.tgz");
    server_.Give("/desk.tgz", archive_);
    server_.Give("/poses.csv", "0,1,2\n");
    WriteBytes(folder_ / "own/desk/SHA256SUMS", Sha256OfText("one") + "  rgb/1.png\n" +
                                                    Sha256OfText("two") + "  rgb/2.png\n" +
                                                    Sha256OfText("0 1 2\n") + "  poses.txt\n");
    WriteBytes(folder_ / "own/desk/objects.json", "[]");
    WriteBytes(folder_ / "own/desk/prepare.sh", "tr , ' ' < poses.csv > poses.txt\n");
    WriteTable(std::to_string(archive_.size()), Sha256OfText(archive_));
  }

  ~FetchTest() override { ::umount((folder_ / "data").c_str()); }

  void SetUp() override {
    for (const char* program : {"curl", "bsdtar"}) {
      if (RunCommand({"which", program}).exit_code != 0) GTEST_SKIP() << "there is no " << program;
    }
  }

  // The table with these bytes and sum for the archive.
  void WriteTable(const std::string& bytes, const std::string& sum) const {
    WriteBytes(folder_ / "downloads.tsv",
               fmt::format("# comment\n"
                           "desk\thttp://nowhere.invalid/a/desk.tgz\t{}\t{}\ttop/rgb/\trgb/\tCC0\n"
                           "desk\thttp://nowhere.invalid/poses.csv\t-\t-\t-\tposes.csv\tMIT\n",
                           bytes, sum));
  }
  // The published files as they are now, as an archive.
  void Pack() const {
    ExpectSuccess(RunCommand({"tar", "-C", (folder_ / "published").string(), "-czf",
                              (folder_ / "desk.tgz").string(), "top"}));
  }
  // From the server, unless a setting says otherwise.
  CommandResult Fetch(const std::string& setting = "WITHOUT=",
                      const std::string& name = "desk") const {
    return RunCommand({"env", "MIRROR=" + server_.Address(), setting,
                       SOSLAM_SOURCE_DIR "/pipelines/fetch.sh",
                       (folder_ / "downloads.tsv").string(), (folder_ / "own").string(),
                       (folder_ / "data").string(), name});
  }
  fs::path Target() const { return folder_ / "data/desk"; }
  fs::path Part() const { return folder_ / "data/.downloads/desk/desk.tgz.part"; }

  void ExpectWhole(const CommandResult& fetched) const {
    ExpectSuccess(fetched);
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(Target())) {
      if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(Target()));
    }
    EXPECT_THAT(names, testing::UnorderedElementsAre("SHA256SUMS", "objects.json", "poses.txt",
                                                     "rgb/1.png", "rgb/2.png"));
    EXPECT_EQ(FileBytes(Target() / "rgb/1.png"), "one");
    EXPECT_EQ(FileBytes(Target() / "poses.txt"), "0 1 2\n");
    EXPECT_FALSE(fs::exists(folder_ / "data/.downloads/desk"));
  }
  void ExpectFailed(const CommandResult& fetched, int exit_code,
                    const std::vector<std::string>& words) const {
    ExpectExit(exit_code, fetched);
    for (const std::string& word : words) EXPECT_THAT(fetched.errors, HasSubstr(word));
    EXPECT_FALSE(fs::exists(Target()));
  }

  TemporaryFolder folder_;
  std::string noise_;
  std::string archive_;
  HttpServer server_;
};

TEST_F(FetchTest, FromAServer) {
  const CommandResult fetched = Fetch();
  ExpectWhole(fetched);
  EXPECT_THAT(fetched.output, HasSubstr("desk.tgz (CC0)"));
  EXPECT_THAT(fetched.output, HasSubstr("3 files fetched and checked"));
  EXPECT_THAT(server_.Requests(), ElementsAre("/desk.tgz", "/poses.csv"));
}

TEST_F(FetchTest, FilesThatTheArchiveHasReadOnlyAreTheUsers) {
  fs::permissions(folder_ / "published/top/rgb/1.png", fs::perms::owner_read);
  Pack();
  WriteBytes(folder_ / "poses.csv", "0,1,2\n");
  WriteTable("-", "-");
  ExpectWhole(Fetch("MIRROR=file://" + folder_.path().string()));
  EXPECT_EQ(fs::status(Target() / "rgb/1.png").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(FetchTest, ByMake) {
  ExpectWhole(RunMake(
      {"-C", SOSLAM_SOURCE_DIR, "data", "DATASET=desk", "MIRROR=" + server_.Address(),
       "DOWNLOADS=" + (folder_ / "downloads.tsv").string(),
       "ANNOTATIONS=" + (folder_ / "own").string(), "DATA_ROOT=" + (folder_ / "data").string()}));
}

TEST_F(FetchTest, OfANetworkByMakeOnlyThePublishedOne) {
  server_.Give("/yolox_nano.onnx", std::string(3659407, 'x'));
  const CommandResult made =
      ExpectExit(2, RunMake({"-C", SOSLAM_SOURCE_DIR, "network", "MIRROR=" + server_.Address(),
                             "NETWORKS=" + (folder_ / "networks").string()}));
  EXPECT_THAT(made.output, HasSubstr("Apache-2.0"));
  EXPECT_THAT(made.errors, HasSubstr("yolox_nano.onnx: found 3659407 bytes with SHA-256"));
  EXPECT_FALSE(fs::exists(folder_ / "networks/yolox_nano"));
}

TEST_F(FetchTest, WhatIsWholeIsNotFetchedAgainButItsAnnotationIsLaid) {
  Fetch();
  WriteBytes(folder_ / "own/desk/objects.json", "[1]");
  const size_t requests = server_.Requests().size();
  ExpectSuccess(Fetch());
  EXPECT_EQ(server_.Requests().size(), requests);
  EXPECT_EQ(FileBytes(Target() / "objects.json"), "[1]");
}

TEST_F(FetchTest, AFolderThatIsThereCanBeLeftOut) {
  ExpectFailed(Fetch("WITHOUT=images"), 2, {"WITHOUT=images", "expected", "rgb/"});
  EXPECT_THAT(server_.Requests(), IsEmpty());
  ExpectSuccess(Fetch("WITHOUT=rgb"));
  EXPECT_TRUE(fs::exists(Target() / "poses.txt"));
  EXPECT_FALSE(fs::exists(Target() / "rgb"));
  EXPECT_THAT(server_.Requests(), ElementsAre("/poses.csv"));
}

// Also over a third run, which finds nothing to do.
TEST_F(FetchTest, AnnotationThatTheUserChangedIsKeptBesideOurs) {
  Fetch();
  WriteBytes(Target() / "objects.json", "mine");
  for (int run = 0; run < 2; ++run) ExpectSuccess(Fetch());
  EXPECT_EQ(FileBytes(Target() / "objects.json"), "[]");
  EXPECT_EQ(FileBytes(Target() / "objects.json~"), "mine");
}

TEST_F(FetchTest, TwoAtOnceAreOneAfterTheOther) {
  CommandResult other;
  std::thread at_once([&] { other = Fetch(); });
  const CommandResult own = Fetch();
  at_once.join();
  ExpectWhole(own);
  ExpectWhole(other);
  EXPECT_THAT(server_.Requests(), ElementsAre("/desk.tgz", "/poses.csv"));
}

TEST_F(FetchTest, AFileThatWasLostIsFetchedAgain) {
  Fetch();
  fs::remove(Target() / "rgb/2.png");
  ExpectWhole(Fetch());
}

TEST_F(FetchTest, HalfAFileIsGoneOnWith) {
  for (const bool size_is_known : {true, false}) {
    if (!size_is_known) WriteTable("-", "-");
    server_.EndAfter(6000);
    ExpectFailed(Fetch(), 4, {"desk.tgz: the connection ended", "goes on with it"});
    EXPECT_EQ(FileBytes(Part()), archive_.substr(0, 6000));
    server_.EndAfter(std::string::npos);
    ExpectWhole(Fetch());
    EXPECT_EQ(server_.Requests()[1], "/desk.tgz from 6000");
    fs::remove_all(Target());
  }
}

TEST_F(FetchTest, AServerThatGivesNoPartsGivesTheWholeAgain) {
  server_.EndAfter(6000);
  Fetch();
  server_.EndAfter(std::string::npos);
  server_.WholeFilesOnly();
  ExpectWhole(Fetch());
}

// Killed when all bytes were there and their name was not.
TEST_F(FetchTest, AWholeFileWithoutItsNameIsTaken) {
  for (const bool size_is_known : {true, false}) {
    if (!size_is_known) WriteTable("-", "-");
    fs::create_directories(Part().parent_path());
    WriteBytes(Part(), archive_);
    ExpectWhole(Fetch());
    fs::remove_all(Target());
  }
}

TEST_F(FetchTest, AnArchiveOfAnotherSumIsRefusedAndRemoved) {
  const std::string expected = Sha256OfText("another");
  WriteTable(std::to_string(archive_.size()), expected);
  ExpectFailed(Fetch(), 3,
               {"desk.tgz: found", Sha256OfText(archive_), "expected", expected, "is removed"});
  EXPECT_FALSE(fs::exists(Part()));
}

TEST_F(FetchTest, AnArchiveThatIsTooShortIsGoneOnWith) {
  server_.Give("/desk.tgz", archive_.substr(0, 9000));
  ExpectFailed(Fetch(), 3, {fmt::format("9000 bytes came; expected {}", archive_.size())});
  server_.Give("/desk.tgz", archive_);
  ExpectWhole(Fetch());
  EXPECT_THAT(server_.Requests(), ElementsAre("/desk.tgz", "/desk.tgz from 9000", "/poses.csv"));
}

TEST_F(FetchTest, AFileOfAnotherSumIsNotLaid) {
  server_.Give("/poses.csv", "0,1,3\n");
  ExpectFailed(Fetch(), 3,
               {"poses.txt of desk: found SHA-256 " + Sha256OfText("0 1 3\n"),
                "expected " + Sha256OfText("0 1 2\n")});
}

TEST_F(FetchTest, AFileThatTheArchiveLacksIsNamed) {
  WriteBytes(folder_ / "own/desk/SHA256SUMS", Sha256OfText("four") + "  rgb/4.png\n");
  ExpectFailed(Fetch(), 3, {"rgb/4.png of desk: found SHA-256 nothing"});
}

// Its sum is not known: it is whole if it can be unpacked.
TEST_F(FetchTest, ADamagedArchiveIsRemovedAndFetchedAnew) {
  WriteTable("-", "-");
  server_.Give("/desk.tgz", archive_.substr(0, 9000));
  ExpectFailed(Fetch(), 3, {"desk.tgz: cannot be unpacked", "a folder top/rgb/"});
  server_.Give("/desk.tgz", archive_);
  ExpectWhole(Fetch());
}

TEST_F(FetchTest, AnAddressWithoutTheFile) {
  ExpectFailed(Fetch("MIRROR=" + server_.Address() + "/nowhere"), 4,
               {"error: 404", "desk.tgz: refused", "publisher moved"});
  ExpectFailed(Fetch("MIRROR=file://" + (folder_ / "nowhere").string()), 4, {"has no such file"});
}

TEST_F(FetchTest, NoNetwork) {
  const std::string closed = HttpServer().Address();
  ExpectFailed(Fetch("MIRROR=" + closed), 4, {closed + "/desk.tgz: no answer; expected a network"});
}

TEST_F(FetchTest, AFolderOfSomebodyElseStaysAsItIs) {
  fs::create_directory(Target());
  WriteBytes(Target() / "objects.json", "mine");
  EXPECT_THAT(ExpectExit(2, Fetch()).errors, HasSubstr("was not made by this command"));
  EXPECT_EQ(FileBytes(Target() / "objects.json"), "mine");
  EXPECT_THAT(server_.Requests(), IsEmpty());
}

TEST_F(FetchTest, AFolderThatCannotBeWrittenTo) {
  fs::remove(folder_ / "data");
  WriteBytes(folder_ / "data", "a file");
  ExpectFailed(Fetch(), 2, {"data cannot be written to"});
}

TEST_F(FetchTest, AFullDisk) {
  const std::string disk = (folder_ / "data").string();
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=12k") != 0) {
    GTEST_SKIP() << "needs root, to mount a small disk";
  }
  ExpectFailed(Fetch(), 4, {"cannot write", "is full"});
  ASSERT_EQ(::mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=30k"), 0);
  ExpectFailed(Fetch(), 3, {"cannot be unpacked", "room on the disk"});
  ASSERT_EQ(::mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=1m"), 0);
  ExpectWhole(Fetch());
}

TEST_F(FetchTest, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  ExpectFailed(Fetch("WITHOUT=", "chair"), 2,
               {"nothing is known of 'chair'; expected one of desk"});
}

}  // namespace
}  // namespace soslam
