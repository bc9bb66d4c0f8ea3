// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/appearance_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/pictures.h"
#include "support/scene.h"

namespace soslam {
namespace {

class AppearanceFileTest : public FolderTest {
 protected:
  AppearanceFileTest() {
    for (const Detection& detection : sequence_.detections) {
      AppearanceRecord record{sequence_.FrameOf(detection).id, sequence_.ObjectOf(detection).id,
                              PictureFrom(0.3 * static_cast<double>(records_.size())),
                              Eigen::Vector3f(0.6F, 0.0F, 0.8F), 1.5F};
      record.appearance.direction_correlation_deg = 20.0F;
      if (records_.size() % 2 == 0) {
        record.appearance.log_ratios = LogRatios{{-0.1F, 0.2F}, {0.3F, 0.4F}};
      }
      records_.push_back(record);
    }
  }
  void Write() const { WriteAppearance(path_, records_, {}); }
  void ExpectRefused(std::vector<std::string> words) {
    Write();
    words.push_back("appearance.h5");
    ExpectError<InputError>([&] { AddAppearance(path_, &sequence_); }, words);
  }

  std::filesystem::path path_ = folder_ / "appearance.h5";
  Sequence sequence_ = CuboidSequence(2, 4);
  std::vector<AppearanceRecord> records_;
};

TEST_F(AppearanceFileTest, GivesDetectionsWhatWasWritten) {
  Write();
  AddAppearance(path_, &sequence_);
  for (size_t i = 0; i < records_.size(); ++i) {
    const BoxAppearance& written = records_[i].appearance;
    const auto& read = sequence_.detections[i].appearance;
    ASSERT_TRUE(read);
    EXPECT_EQ(read->azimuth_costs, written.azimuth_costs);
    EXPECT_EQ(read->direction_correlation_deg, 20.0F);
    ASSERT_EQ(read->log_ratios.has_value(), i % 2 == 0);
    if (!read->log_ratios) continue;
    EXPECT_EQ(read->log_ratios->mean, written.log_ratios->mean);
    EXPECT_EQ(read->log_ratios->sigma, written.log_ratios->sigma);
  }
  const auto records = ReadAppearance(path_);
  ASSERT_EQ(records.size(), records_.size());
  EXPECT_EQ(records.back().object_id, records_.back().object_id);
  EXPECT_EQ(records.back().descriptor, records_.back().descriptor);
  EXPECT_EQ(records.back().distance, 1.5F);
}

TEST_F(AppearanceFileTest, RatiosAreFiniteOrZeros) {
  records_[2].appearance.log_ratios = LogRatios{{0.1F, 0.2F}, {0.3F, -0.4F}};
  ExpectRefused({"/log_ratios", "row 2", "expected"});
}

TEST_F(AppearanceFileTest, MayHaveNoRecord) {
  records_.clear();
  Write();
  EXPECT_TRUE(ReadAppearance(path_).empty());
  AddAppearance(path_, &sequence_);
  EXPECT_FALSE(sequence_.detections.front().appearance);
}

TEST_F(AppearanceFileTest, RecordsOfOtherBoxesAreRefused) {
  records_[1].object_id = 4711;
  ExpectRefused({"object 4711", "the sequence has not"});
}

TEST_F(AppearanceFileTest, ABoxHasOneRecord) {
  records_.push_back(records_[1]);
  ExpectRefused({"twice", fmt::format("frame {}", records_[1].frame_id)});
}

TEST_F(AppearanceFileTest, NumbersThatMeanNothingAreRefused) {
  using Change = std::function<void(AppearanceRecord*)>;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::pair<Change, std::vector<std::string>> bad[] = {
      {[](AppearanceRecord* record) { record->appearance.azimuth_costs[7] = -0.1F; },
       {"/azimuth_cost", "row 1", "at least 0"}},
      {[](AppearanceRecord* record) { record->appearance.azimuth_costs[7] = kNone; },
       {"/azimuth_cost", "row 1", "finite"}},
      {[](AppearanceRecord* record) { record->distance = INFINITY; }, {"/distance", "row 1"}},
      {[](AppearanceRecord* record) { record->descriptor[1] = kNone; }, {"/descriptor", "row 1"}}};
  const auto right = records_;
  for (const auto& [change, words] : bad) {
    records_ = right;
    change(&records_[1]);
    ExpectRefused(words);
  }
  records_ = right;
  records_.front().appearance.direction_correlation_deg = -3.0F;  // that of the file
  ExpectRefused({"direction_correlation_deg", "-3", "180"});
}

TEST_F(AppearanceFileTest, FilesOfOtherKindsAreRefused) {
  CreateArtefact(path_, "edges", {}).Close();
  ExpectError<InputError>([&] { ReadAppearance(path_); }, {"appearance.h5", "edges"});
  ExpectError<InputError>([&] { ReadAppearance(folder_ / "none.h5"); }, {"none.h5"});
}

}  // namespace
}  // namespace soslam
