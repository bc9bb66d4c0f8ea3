// SPDX-License-Identifier: BSD-3-Clause
// The usual mistakes in boxes, tracks, labels and true objects.
#include "support/dataset_checks_fixture.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::IsEmpty;

// Boxes.

TEST_F(DatasetChecksTest, BoxesThatCannotBe) {
  using Numbers = std::array<double, 4>;
  const std::vector<std::pair<Numbers (*)(const Box&), std::vector<std::string>>> cases = {
      {[](const Box& b) {
         return Numbers{b.x_min, b.y_min, b.Width(), b.Height()};
       },
       {"meant as upper left corner and size"}},
      {[](const Box& b) {
         return Numbers{b.x_min / 640, b.y_min / 480, b.x_max / 640, b.y_max / 480};
       },
       {"fractions of the image"}},
      {[](const Box& b) {
         return Numbers{3 * b.x_min, 3 * b.y_min, 3 * b.x_max, 3 * b.y_max};
       },
       {"images of another size"}},
      {[](const Box& b) {
         return Numbers{639 - b.x_max, b.y_min, 639 - b.x_min, b.y_max};
       },
       {"boxes are mirrored left to right", "as selfie cameras do"}},
      {[](const Box& b) {
         return Numbers{b.x_min, 479 - b.y_max, b.x_max, 479 - b.y_min};
       },
       {"boxes with y up"}}};
  for (const auto& [numbers, words] : cases) {
    dataset.box = numbers;
    ExpectRefused(words);
  }
}

TEST_F(DatasetChecksTest, CornersWhereSizesBelong) {
  WriteCoco([](const Box& b) { return std::array{b.x_min, b.y_min, b.x_max, b.y_max}; });
  ExpectRefused({"meant as two corners"});
}

// Boxes on the right of the image reach out of it.
TEST_F(DatasetChecksTest, CentresWhereCornersBelong) {
  WriteCoco([](const Box&) { return std::array{500.0, 300.0, 200.0, 150.0}; });
  ExpectRefused({"meant as centre and size"});
}

TEST_F(DatasetChecksTest, AFewBoxesOutOfTheImage) {
  dataset.box = [count = 0](const Box& b) mutable {
    const double shift = ++count % 8 == 0 ? 600.0 : 0.0;
    return std::array{b.x_min + shift, b.y_min, b.x_max + shift, b.y_max};
  };
  ExpectAmongWarnings({"box_convention: 14 of 115 boxes"});
}

// A box of the whole thing, also where the image cuts it.
TEST_F(DatasetChecksTest, BoxesOfWholeThingsAreNoOtherConvention) {
  dataset.box = [](const Box& b) {
    const auto wide = [](double x, double size) { return 0.5 * size + 4.0 * (x - 0.5 * size); };
    return std::array{wide(b.x_min, 640), wide(b.y_min, 480), wide(b.x_max, 640),
                      wide(b.y_max, 480)};
  };
  ExpectAmongWarnings({"whole objects that the image cuts"});
}

TEST_F(DatasetChecksTest, AnOrbitAroundThingsInTheMiddleIsNoSmallerImage) {
  dataset.camera.fx = dataset.camera.fy = dataset.written_camera.fx = dataset.written_camera.fy =
      200;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, ScoresInPerCent) {
  dataset.score = "87";
  ExpectWarning({"115 of 115 scores", "per cent"});
}

TEST_F(DatasetChecksTest, BoxesThatTheBorderGateDrops) {
  options_.border_px = 200;
  options_.min_observations = 1;
  ExpectWarning({"rejected_near_border", "border_px"});
}

// Objects that boxes are of.

TEST_F(DatasetChecksTest, HalfOfTheBoxesOfNoTrack) {
  dataset.first_object_id = -2;
  dataset.label = [](size_t) { return "ball"; };
  ExpectWarning({"rejected_without_object_id: 46 of 115", "a tracker that finds few tracks"});
}

// Labels.

TEST_F(DatasetChecksTest, LabelsThatFlicker) {
  const auto flicker = [](int of_seven) {
    return [of_seven, count = 0](size_t ball) mutable {
      return count++ % 7 < of_seven ? "thing" : PlausibleDataset::Labels()[ball];
    };
  };
  dataset.label = flicker(1);
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.label = flicker(3);
  ExpectWarning(
      {"labels_of_objects: detections.csv: 51 of 115 boxes", "ids that are of several things"});
}

TEST_F(DatasetChecksTest, LabelsThatNoBoxHasAreNamed) {
  options_.labels = "ball, cup";
  EXPECT_THAT(Warnings(), IsEmpty());
  options_.labels = "ball, Botle, sofa";
  ExpectWarning({"no box has the label Botle (bottle?), sofa of `labels`",
                 "expected labels of boxes: ball, bottle, bowl"});
  options_.labels = "Botle";
  ExpectError<NothingUsableError>([&] { Import(); }, {"115 other_label", "Botle", "bottle"});
}

class ClassNamesTest : public DatasetChecksTest {
 protected:
  // YOLO's labels with these classes for the five balls, and these lines of names.
  void WriteYolo(const std::array<int, 5>& classes, const std::string& names) {
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      std::string lines;
      for (size_t ball = 0; ball < classes.size(); ++ball) {
        const Box box = dataset.BoxOf(ball, frame);
        lines += fmt::format("{} {} {} {} {}\n", classes[ball], (box.Centre().x() + 0.5) / 640,
                             (box.Centre().y() + 0.5) / 480, box.Width() / 640, box.Height() / 480);
      }
      Write(fmt::format("labels/{:06}.txt", frame), lines);
    }
    Write("names.txt", names);
    options_.detections = "labels";
    options_.folder.detections_format = DetectionsFormat::kYolo;
    options_.folder.class_names = "names.txt";
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  }
};

TEST_F(ClassNamesTest, AreRight) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\ntable\n\n");
  EXPECT_THAT(Warnings(), IsEmpty());
}

// The left edge is by 2 % of the width out of the image. The boxes of no track count, too.
TEST_F(ClassNamesTest, BoxesThatReachBeyondTheImage) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\n");
  dataset.objects = "";
  for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
    Write(fmt::format("labels/{:06}.txt", frame),
          "0 0.03 0.5 0.1 0.2 0.9 -1\n1 0.5 0.5 0.1 0.2 0.9 1\n");
  }
  ExpectAmongWarnings({"boxes_cut: labels: 24 of 48 boxes"});
}

TEST_F(ClassNamesTest, AreCountedFromOne) {
  WriteYolo({1, 3, 5, 7, 9}, "ball\na\ncup\nb\nvase\nc\nbowl\nd\nbottle\ne\n");
  ExpectWarning({"class_numbers: 0 of 120", "but 120 if", "one lower"});
}

TEST_F(ClassNamesTest, HaveABlankLineBetween) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\n\nvase\nbowl\nbottle\n");
  ExpectWarning({"names.txt has 1 blank lines"});
}

// Objects.

TEST_F(DatasetChecksTest, TrueObjectsWhereTheyAreSeen) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, IdsFromZeroInOneFile) {
  dataset.label = [](size_t) { return "ball"; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/0, /*unit_m=*/1.0);
  ExpectWarning({"objects_against_boxes", "subtract 1 from the object_id"});
}

// Full sizes; centimetres, where cameras are within objects, which have no outline then;
// kilometres.
TEST_F(DatasetChecksTest, HalfAxesOfAnotherUnit) {
  for (const auto& [factor, words] :
       {std::pair(2.0, "full sizes"), {100.0, "centimetres"}, {1e-3, "another unit"}}) {
    dataset.true_radius = factor * PlausibleDataset::kRadius;
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
    ExpectWarning({"object_half_axes", words});
  }
}

// The upright boxes around oblique ones reach out of the image, and are not those of true objects.
TEST_F(DatasetChecksTest, ObliqueBoxesAreNoOtherMistake) {
  dataset.label = [](size_t) { return "chair"; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  const auto write = [&](double wider, double rotation) {
    WriteCoco(
        [wider](const Box& b) {
          return std::array{b.Centre().x() + 0.5 - 0.5 * wider * b.Width(), b.y_min + 0.5,
                            wider * b.Width(), b.Height()};
        },
        [rotation](size_t ball) {
          return nlohmann::json{{"track_id", ball + 1}, {"attributes", {{"rotation", rotation}}}};
        });
  };
  write(2.5, 45.0);
  ExpectWarning({"oblique_boxes", "120 of 120"});
  write(2.5, 90.0);
  ExpectWarning({"object_half_axes"});
  write(10.0, 45.0);
  ExpectAmongWarnings({"oblique_boxes"});
  write(10.0, 90.0);
  ExpectRefused<NothingUsableError>({"reach out of the image"});
}

// The rotation by 40 degrees about z with qw first.
TEST_F(DatasetChecksTest, TrueQuaternionsWithScalarFirst) {
  dataset.true_quaternion = "0.94, 0, 0, 0.342";
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  ExpectWarning({"object_axes", "qw first"});
}

TEST_F(DatasetChecksTest, TrueObjectsInMillimetres) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1e-3);
  ExpectWarning({"another world, unit or order of axes"});
}

}  // namespace
}  // namespace soslam
