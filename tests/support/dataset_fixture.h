// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "support/temporary_folder.h"

namespace soslam {

// The text files of a small valid dataset, for a test to change before writing them: four images,
// one plane, object 1 (cup, with ground truth, detected four times) and object 2 (box, detected
// three times). All detections are usable with the default options.
struct DatasetFixture {
  std::map<std::string, std::string> files = {
      {"rgb.txt",
       "# timestamp filename\n1.0 rgb/0.jpg\n2.0 rgb/1.jpg\n3.0 rgb/2.jpg\n"
       "4.0 rgb/3.jpg\n"},
      {"groundtruth.txt",
       "# timestamp tx ty tz qx qy qz qw\n"
       "1.0 0 0 1 0 0 0 1\n2.0 0.1 0 1 0 0 0 1\n3.0 0.2 0 1 0 0 0 1\n"
       "4.0 0.3 0 1 0 0 0 1\n"},
      {"odometry.txt",
       "1.001 0 0 1.5 0 0 0 1\n2.001 0.11 0 1.5 0 0 0 1\n"
       "3.001 0.22 0 1.5 0 0 0 1\n4.001 0.33 0 1.5 0 0 0 1\n"},
      {"camera.json", R"({"model": "pinhole", "width": 640, "height": 480,
                          "fx": 500.0, "fy": 510.0, "cx": 319.5, "cy": 239.5})"},
      {"planes.json", R"([{"id": 0, "label": "floor", "normal": [0, 0, 2], "d": -1}])"},
      {"objects.json", R"([{"id": 1, "label": "cup", "center": [1, 2, 3],
                            "quaternion_xyzw": [0, 0, 0.6, 0.8], "half_axes": [0.1, 0.2, 0.3],
                            "mirror_symmetric": true, "support_plane": 0}])"},
      {"detections.csv",
       "frame,object_id,label,score,x1,y1,x2,y2\n"
       "0,1,cup,0.9,100,100,200,200\n0,2,box,0.8,300,100,400,200\n"
       "1,1,cup,0.9,101,100,201,200\n1,2,box,0.8,301,100,401,200\n"
       "2,1,cup,0.9,102,100,202,200\n2,2,box,0.8,302,100,402,200\n"
       "3,1,cup,0.9,103,100,203,200\n"}};

  // Replaces the first `from` in a file, which has to be there.
  void Replace(const std::string& file, const std::string& from, const std::string& to) {
    std::string& text = files.at(file);
    const size_t found = text.find(from);
    ASSERT_NE(found, std::string::npos) << file << " has no " << from;
    text.replace(found, from.size(), to);
  }

  void Write(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
    for (const auto& [name, text] : files) std::ofstream(folder / name, std::ios::binary) << text;
  }
};

}  // namespace soslam
