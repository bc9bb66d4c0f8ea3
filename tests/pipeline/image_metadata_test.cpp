// SPDX-License-Identifier: BSD-3-Clause
// Where and by whom images were taken stays in the images.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "soslam/system/hash.h"
#include "support/image_files.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

const std::string kArtist = "Grete Musterfrau of Nowhere", kSerialNumber = "SN-4711-0815-2342";
// 52 degrees 31 minutes 14.281 seconds, as EXIF's rational numbers.
const std::string kLatitude =
    NumberBytes(52, 4, ByteOrder::kBigEndian) + NumberBytes(1, 4, ByteOrder::kBigEndian) +
    NumberBytes(31, 4, ByteOrder::kBigEndian) + NumberBytes(1, 4, ByteOrder::kBigEndian) +
    NumberBytes(14281, 4, ByteOrder::kBigEndian) + NumberBytes(1000, 4, ByteOrder::kBigEndian);

// Orientation, artist, serial number of the camera, position.
std::string Exif() {
  const size_t artist = TiffRest(4), serial = artist + kArtist.size() + 1;
  const size_t gps = serial + kSerialNumber.size() + 1;
  std::string position = Tiff(ByteOrder::kBigEndian, {{2, gps + 18, 5, 3}}).substr(8);
  return Tiff(ByteOrder::kBigEndian,
              {{274, 1},
               {315, artist, 2, kArtist.size() + 1},
               {0xC62F, serial, 2, kSerialNumber.size() + 1},
               {34853, gps, 4}},
              kArtist + '\0' + kSerialNumber + '\0' + position + kLatitude);
}

// A secret as it is, and as it is within base 64 from each of three places on.
std::vector<std::string> Appearances(const std::string& secret) {
  std::vector<std::string> appearances = {secret};
  for (size_t begin = 0; begin < 3; ++begin) {
    const size_t count = (secret.size() - begin) / 3 * 3;
    appearances.push_back(Base64(std::string_view(secret).substr(begin, count)));
  }
  return appearances;
}

bool Holds(const std::string& bytes, const std::string& secret) {
  return std::ranges::any_of(Appearances(secret), [&](const std::string& appearance) {
    return bytes.find(appearance) != bytes.npos;
  });
}

TEST(ImageMetadataTest, DoesNotReachArtefactsPagesOrExports) {
  const SmallPipeline pipeline(4);
  for (const auto& entry : fs::directory_iterator(pipeline.Dataset() / "rgb")) {
    const cv::Mat image = cv::imread(entry.path().string());
    WriteBytes(entry.path(), JpegWithExif(EncodedImage(".jpg", image), Exif()));
  }
  ExpectSuccess(pipeline.Run("OursPT"));
  const fs::path results = pipeline.Folder() / "results";
  const auto run = [&](const std::string& stage, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), StageProgram(stage));
    ExpectSuccess(RunCommand(arguments));
  };
  const auto result = [&](const std::string& name) {
    return (pipeline.Results() / "OursPT" / name).string();
  };
  run("pages", {"--results", results.string()});
  run("export", {"--sequence", result("sequence.json"), "--map", result("map.json"), "--ply",
                 result("m.ply"), "--gltf", result("m.glb"), "--coco_dataset", result("d.json"),
                 "--trajectory", result("t.txt"), "--csv", result("l.csv")});
  run("inspect", {result("sequence.json"), "--dataset", pipeline.Dataset().string(), "--frame", "0",
                  "--image", result("picture.png")});
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(results)) {
    if (!fs::is_regular_file(entry.path())) continue;
    const std::string bytes = FileBytes(entry.path());
    for (const std::string& secret : {kArtist, kSerialNumber, kLatitude}) {
      EXPECT_FALSE(Holds(bytes, secret)) << entry.path() << ": " << secret;
    }
    ++files;
  }
  EXPECT_GT(files, 15);
}

}  // namespace
}  // namespace soslam
