// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "dataset/dataset_content.h"
#include "support/dataset_fixture.h"
#include "support/run_command.h"

namespace soslam {

// Four colour images, paired with depth images, of which the first is there; true poses that are
// 4 ms late, none near the last image; no planes, no object ids.
class FolderFormatsTest : public testing::Test {
 protected:
  FolderFormatsTest() {
    options_.format = DatasetFormat::kTumRgbd;
    options_.folder.images = "pairs.txt";
    options_.folder.camera = "640 480 500 510 319.5 239.5";
    options_.border_px = 0.0;
    Write("pairs.txt",
          "1.0 rgb/1.0.png 1.1 depth/1.1.png\n2.0 rgb/2.0.png 2.1 depth/2.1.png\n"
          "3.0 rgb/3.0.png 3.1 depth/3.1.png\n4.0 rgb/4.0.png 4.1 depth/4.1.png\n");
    Write("rgb/1.0.png", "an image");
    Write("groundtruth.txt",
          "1.004 0 0 1 0 0 0 1\n2.004 0.1 0 1 0 0 0 1\n3.004 0.2 0 1 0 0 0 1\n"
          "3.5 9 9 9 0 0 0 1\n");
    Write("detections.csv",
          "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,100,100,200,200\n0,cup,0.8,300,100,400,200\n"
          "1,book,0.9,101,100,201,200\n3,cup,0.9,103,100,203,200\n");
  }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  // Puts folder txts into the archive txts.tar.gz.
  void PackTxts() const {
    const std::string archive = (folder_ / "txts.tar.gz").string();
    EXPECT_EQ(RunCommand({"tar", "czf", archive, "-C", folder_.string(), "txts"}).exit_code, 0);
    std::filesystem::remove_all(folder_ / "txts");
  }
  Sequence Import() const { return ImportDataset(folder_, options_); }
  // Imports detections of this format, of which there has to be one.
  Detection ImportOne(DetectionsFormat format, const std::string& name) {
    options_.folder.detections_format = format;
    options_.detections = name;
    const Sequence sequence = Import();
    EXPECT_EQ(sequence.detections.size(), 1u);
    EXPECT_EQ(sequence.ObjectOf(sequence.detections.at(0)).label, "cup");
    return sequence.detections.at(0);
  }

  std::filesystem::path folder_ = FreshTestFolder() / "folder";
  ImportOptions options_;
};

}  // namespace soslam
