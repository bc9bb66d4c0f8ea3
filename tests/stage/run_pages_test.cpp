// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/lists.h"
#include "support/printed.h"
#include "support/results_folder.h"
#include "support/scene.h"
#include "support/temporary_folder.h"
#include "support/true_map.h"

namespace soslam {
namespace {

// What a page for browsers shows.
nlohmann::json PageDataIn(const std::filesystem::path& page) {
  const std::string html = FileBytes(page);
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const size_t begin = html.find(open) + open.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// Results of one dataset, "room", with images.
class RunPagesTest : public FolderTest {
 protected:
  RunPagesTest() {
    for (Frame& frame : sequence_.frames) frame.image = std::to_string(frame.id) + ".png";
    const Camera& camera = sequence_.camera;
    const cv::Mat grey(camera.height, camera.width, CV_8UC3, cv::Scalar(90, 120, 60));
    for (const Frame& frame : sequence_.frames) {
      Write("data/" + frame.image, EncodedImage(".png", grey));
    }
    WriteBytes(results_.VariantFolder("room", "shared") / "dataset.txt", Dataset().string() + "\n");
  }
  fs::path Dataset() const { return folder_ / "data"; }
  fs::path Folder(const std::string& variant) const {
    return results_.VariantFolder("room", variant);
  }
  fs::path Page() const { return results_.path() / "room/report.html"; }

  // Without the last object, and with covariances as a back end has them.
  std::vector<ObjectEstimate> Estimates() const {
    std::vector<ObjectEstimate> objects = TrueMap(sequence_).objects;
    objects.pop_back();
    for (ObjectEstimate& object : objects) {
      object.covariance = Covariance9(0.0123456 * Covariance9::Identity());
    }
    return objects;
  }
  void WriteVariant(const std::string& name, const std::vector<std::string>& runs) const {
    WriteSequence(Folder(name) / "sequence.json", sequence_, {});
    results_.WriteMetrics("room", name, {{.id = sequence_.objects[0].id, .iou = 0.5}});
    results_.WriteStages("room", name, runs);
    for (const std::string& run : runs) WriteBytes(Folder("shared/" + run) / "done", "");
  }
  ArtefactInfo MadeOf(const std::string& name) const {
    return {{}, {Folder(name) / "sequence.json"}};
  }
  void WriteMultiView(const std::string& name) const {
    WriteVariant(name, {"import-1", "initialise-2", "evaluate-3"});
    WriteLandmarks(Folder(name) / "initial.json", {{}, Estimates()}, sequence_, MadeOf(name));
  }
  void WriteOurs(const std::string& name) const { WriteOurs(name, Map()); }
  void WriteOurs(const std::string& name, const MapEstimate& map) const {
    WriteMultiView(name);
    WriteVariant(name, {"import-1", "initialise-2", "refine-4", "optimise-5", "evaluate-6"});
    WriteMap(Folder(name) / "map.json", map, sequence_, MadeOf(name));
    WriteSymmetry(Folder(name) / "symmetry.h5", {Record()}, {});
  }
  MapEstimate Map() const {
    MapEstimate map = EmptyMap(sequence_);
    map.objects = Estimates();
    return map;
  }
  SymmetryRecord Record() const {
    const Detection& seen = sequence_.detections.front();
    SymmetryRecord record;
    record.frame_id = sequence_.FrameOf(seen).id;
    record.object_id = sequence_.ObjectOf(seen).id;
    record.yaw = {0.0, 1.0, 2.0, 3.0};
    record.cost["grey"] = {3.0, 1.0, 2.0, 4.0};
    record.initial_yaw = record.refined_yaw = 1.0;
    record.true_yaw = 1.1;
    return record;
  }

  Printed Run() const {
    return PrintedBy([&] { RunPages({}, {{"results", results_.path()}}, 2); });
  }
  // Runs, and returns the part of the page that needs no scripts.
  std::string Markup() const {
    EXPECT_EQ(Run().errors, "");
    return MarkupOf(Page());
  }
  static std::string MarkupOf(const fs::path& page) {
    const std::string html = FileBytes(page);
    return html.substr(0, html.find("<script"));
  }
  // Names and states of what is not complete.
  std::map<std::string, std::string> Unfinished() const {
    std::map<std::string, std::string> states;
    const json page = PageDataIn(Page());
    for (const json& variant : page["unfinished"]) {
      states[variant["name"]] = variant["state"];
    }
    return states;
  }

  Sequence sequence_ = CuboidSequence(4, 6);
  ResultsFolder results_;
};

TEST_F(RunPagesTest, VariantsShareWhatIsTheSame) {
  WriteOurs("OursS");
  fs::create_directory(Folder("OursST"));
  for (const auto& file : fs::directory_iterator(Folder("OursS"))) {
    fs::create_symlink(file.path(), Folder("OursST") / file.path().filename());
  }
  const Printed printed = Run();
  EXPECT_EQ(printed.errors, "");
  EXPECT_THAT(printed.output, HasSubstr("2 variants, 6 images"));
  const json page = PageDataIn(Page());
  EXPECT_EQ(page["sequences"].size(), 1u);
  EXPECT_EQ(page["symmetries"].size(), 1u);
  EXPECT_EQ(page["variants"][1]["kind"], "map");
  EXPECT_EQ(page["variants"][1]["symmetry"], 0);
  EXPECT_EQ(page["notes"], json::array());
  EXPECT_EQ(page["sequences"][0]["counts"]["objects"], 4);
}

size_t CountOf(const std::string& words, const std::string& text) {
  size_t count = 0;
  for (size_t at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST_F(RunPagesTest, PagesBeginWithTheMapAndItsPictures) {
  const std::string label = "<chair>";
  sequence_.objects[0].label = label;
  WriteOurs("OursS");
  WriteOurs("OursST");
  const std::string html = Markup();
  EXPECT_LT(html.find("<h2>Map of OursST</h2>"), html.find("<h2>Numbers</h2>"));
  EXPECT_EQ(CountOf("<h2>Map ", html), 1u);
  EXPECT_THAT(html, HasSubstr("3 objects in 6 images."));
  EXPECT_EQ(CountOf("<image ", html), 4u);  // of the objects, the one that is not placed included
  // Each on both plans.
  EXPECT_EQ(CountOf("<use href=\"#picture-0\"", html), 2u);
  EXPECT_EQ(CountOf("id=\"picture-0\"", html), 1u);
  EXPECT_THAT(html, HasSubstr("&lt;chair&gt; " + std::to_string(sequence_.objects[0].id)));
  EXPECT_THAT(html, testing::Not(HasSubstr(label)));
  EXPECT_FALSE(PageDataIn(Page()).contains("map_section"));
}

TEST_F(RunPagesTest, AllBoxesOfWhatAssociationFoundAreShown) {
  WriteOurs("OursS");
  Associations associations;
  associations.tracks = {{.boxes = 1, .detections = 1}};
  associations.objects = {{sequence_.objects[0].id, 0, sequence_.objects[0].label, {}, 1}};
  const Detection& seen = sequence_.detections.front();
  associations.detections = {{.name = {sequence_.FrameOf(seen).id, 1, seen.box},
                              .label = sequence_.objects[0].label,
                              .track = 0,
                              .object = sequence_.objects[0].id}};
  WriteAssociations(Folder("OursS") / "associations.json", associations, {});
  const std::string html = Markup();
  const size_t begin = html.find("<section id=\"boxes\">");
  ASSERT_NE(begin, html.npos);
  EXPECT_EQ(CountOf("<image ", html.substr(begin)), 1u);
  associations.detections[0].name.frame = 999;
  WriteAssociations(Folder("OursS") / "associations.json", associations, {});
  EXPECT_THAT(Run().errors, HasSubstr("the boxes of objects cannot be shown: associations.json"));
}

TEST_F(RunPagesTest, ObjectsWithoutALandmarkAreSeenButNotPlaced) {
  // The back end had nothing to begin with, and the stage before says why.
  WriteOurs("OursS");
  std::vector<ObjectEstimate> initial = Estimates();
  initial.push_back({static_cast<int>(initial.size()), 5, {}, {}, "not_determined_by_its_views"});
  WriteLandmarks(Folder("OursS") / "initial.json", {{}, initial}, sequence_, {});
  const std::string html = Markup();
  const size_t begin = html.find("<h3>Seen but not placed</h3>");
  ASSERT_NE(begin, html.npos);
  const std::string list = html.substr(begin, html.find("</section>", begin) - begin);
  EXPECT_EQ(CountOf("<li>", list), 1u);
  EXPECT_THAT(list, AllOf(HasSubstr("<strong>" + sequence_.objects.back().label + "</strong>"),
                          HasSubstr(" boxes"), HasSubstr("seen from too few sides")));
}

TEST_F(RunPagesTest, PhotosWithoutAPoseAreListed) {
  WriteOurs("OursS");
  EXPECT_THAT(Markup(), testing::Not(HasSubstr("Photos without a pose")));
  sequence_.images_without_pose = {"rgb/a<b.jpg", "rgb/c.jpg"};
  WriteOurs("OursS");
  EXPECT_THAT(Markup(),
              AllOf(HasSubstr("<h3>Photos without a pose</h3>"), HasSubstr("2 photos were taken"),
                    HasSubstr("rgb/a&lt;b.jpg, rgb/c.jpg.")));
}

TEST_F(RunPagesTest, UncertainObjectsAreDashedAndSaidToBe) {
  MapEstimate map = Map();
  for (ObjectEstimate& estimate : map.objects) {
    estimate.covariance = Covariance9(1e-4 * Covariance9::Identity());
  }
  WriteOurs("OursS", map);
  EXPECT_THAT(Markup(), testing::Not(HasSubstr("uncertain: ")));
  map.objects[1].covariance = Covariance9(4.0 * Covariance9::Identity());
  WriteOurs("OursS", map);
  const std::string html = Markup();
  EXPECT_EQ(CountOf("uncertain: it may stand beside its outline; its depth", html), 1u);
  EXPECT_EQ(CountOf("<polygon class=\"uncertain\"", html), 2u);  // on both plans
  EXPECT_EQ(CountOf("Dashed objects are uncertain", html), 1u);
}

TEST_F(RunPagesTest, WithoutTrueObjectsNothingIsSaidOfThem) {
  for (Object& object : sequence_.objects) object.ground_truth.reset();
  for (Frame& frame : sequence_.frames) frame.true_world_from_camera.reset();
  const Sequence without = std::exchange(sequence_, CuboidSequence(4, 6));
  WriteOurs("OursS");
  WriteSequence(Folder("OursS") / "sequence.json", without, {});
  WriteMap(Folder("OursS") / "map.json", Map(), without, MadeOf("OursS"));
  results_.WriteMetrics("room", "OursS", {});
  const std::string html = Markup();
  for (const char* words :
       {"IoU", "Rot", "yaw error", "Numbers", "all true objects", "ATE", "Worst first", "ruth"}) {
    EXPECT_EQ(html.find(words, html.find("<main")), html.npos) << words;
  }
  EXPECT_THAT(html, AllOf(HasSubstr("<h2>Objects</h2>"), HasSubstr("yaw sigma")));
  EXPECT_EQ(PageDataIn(Page())["has_true_objects"], false);
  EXPECT_EQ(PageDataIn(Page())["has_true_poses"], false);
}

TEST_F(RunPagesTest, ADamagedWorldIsNamedAndTheRestIsShown) {
  WriteOurs("OursS");
  WriteBytes(Folder("OursS") / "world.json", "{");
  EXPECT_THAT(Run().errors,
              AllOf(HasSubstr("the map from above cannot be shown: "), HasSubstr("world.json")));
  EXPECT_THAT(MarkupOf(Page()), testing::Not(HasSubstr("<h2>Map</h2>")));
  EXPECT_EQ(PageDataIn(Page())["variants"].size(), 1u);
}

TEST_F(RunPagesTest, AMapOfAnotherSequenceIsNotShown) {
  WriteMultiView("MultiView");
  WriteOurs("OursS");
  sequence_.objects[0].label = "another";
  WriteSequence(Folder("OursS") / "sequence.json", sequence_, {});
  EXPECT_THAT(Run().errors,
              AllOf(HasSubstr("OursS failed: "), HasSubstr("map.json: was not made of")));
  EXPECT_EQ(PageDataIn(Page())["variants"].size(), 1u);
}

// Each damage leaves the other variant as it is.
struct Damage {
  const char* file;
  const char* bytes;  // null: the file is a link that leads nowhere
};
class DamagedVariantTest : public RunPagesTest, public testing::WithParamInterface<Damage> {};

TEST_P(DamagedVariantTest, IsNamedAndTheRestIsShown) {
  WriteMultiView("MultiView");
  WriteOurs("OursS");
  const fs::path file = Folder("OursS") / GetParam().file;
  if (GetParam().bytes == nullptr) {
    fs::remove(file);
    fs::create_symlink("../shared/nowhere/file", file);
  } else {
    WriteBytes(file, GetParam().bytes);
  }
  const Printed printed = Run();
  EXPECT_THAT(printed.errors,
              AllOf(HasSubstr("soslam-pages: room: OursS failed: "), HasSubstr(GetParam().file)));
  EXPECT_EQ(Only(PageDataIn(Page())["variants"])["name"], "MultiView");
  EXPECT_THAT(Unfinished().at("OursS"), HasSubstr(GetParam().file));
  const json overview = PageDataIn(results_.path() / "report.html");
  EXPECT_EQ(overview["datasets"][0]["unfinished"].size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Files, DamagedVariantTest,
                         testing::Values(Damage{"map.json", "{\"artefact\": 3}"},
                                         Damage{"map.json", nullptr}, Damage{"sequence.json", ""},
                                         Damage{"sequence.json", nullptr},
                                         Damage{"symmetry.h5", "no HDF5"},
                                         Damage{"symmetry.h5", nullptr},
                                         Damage{"metrics.json", "["}));

TEST_F(RunPagesTest, OlderResultsAreShownAsSuch) {
  WriteMultiView("MultiView");
  WriteBytes(Folder("shared/evaluate-3") / "failed", "exit code 70: bug\n");
  Run();
  EXPECT_EQ(Only(PageDataIn(Page())["unfinished"])["is_shown"], true);
  EXPECT_EQ(PageDataIn(Page())["variants"].size(), 1u);
}

TEST_F(RunPagesTest, ImagesOutsideTheDatasetAreNotShown) {
  Write("secret.png", "no image");
  sequence_.frames[0].image = "../secret.png";
  WriteMultiView("MultiView");
  EXPECT_THAT(Run().errors, HasSubstr("outside"));
  EXPECT_EQ(PageDataIn(Page())["images"].size(), 5u);
}

// In the frames that see them, and only of runs with points.
TEST_F(RunPagesTest, PointsOfObjectsAreInTheirImages) {
  const Detection& seen = sequence_.detections.front();
  MapEstimate map = Map();
  map.objects[seen.object_index].points = {{1, 0.0, 0.873}};
  const MapPoint of_none{Eigen::Vector3d::Zero(), 0.5, {{sequence_.frames[0].id, {1.0, 2.0}}}};
  const MapPoint of_object{
      Eigen::Vector3d::Zero(), 0.5, {{sequence_.FrameOf(seen).id, {33.25, 44.0}}, {90001, {}}}};
  for (const char* name : {"OursS", "OursSP"}) WriteOurs(name, map);
  WriteVariant("OursSP", {"import-1", "track-7", "initialise-2", "optimise-5", "evaluate-6"});
  WritePoints(Folder("OursSP") / "points.h5", {of_none, of_object}, {});
  EXPECT_EQ(Run().errors, "");
  const json variants = PageDataIn(Page())["variants"];
  EXPECT_TRUE(variants[0]["points"].is_null());
  const json& points = variants[1]["points"];
  EXPECT_EQ(points.size(), sequence_.detections.size());
  EXPECT_EQ(points[0], json({33.3, 44.0, 87}));
  for (size_t i = 1; i < points.size(); ++i) EXPECT_TRUE(points[i].is_null());
  const json& object = variants[1]["objects"][seen.object_index];
  EXPECT_EQ(object["points"], json({{"count", 1}, {"of_object", 0.873}}));

  WritePoints(Folder("OursSP") / "points.h5", {of_none}, {});
  EXPECT_THAT(Run().errors, AllOf(HasSubstr("OursSP failed"), HasSubstr("points.h5: has 1 points"),
                                  HasSubstr("map.json")));
}

// Only a front that is known is drawn.
TEST_F(RunPagesTest, OutlinesSayWhichFrontsAreKnown) {
  const Detection& seen = sequence_.detections.front();
  MapEstimate map = Map();
  map.objects[seen.object_index].front_probability = 0.95;
  WriteOurs("OursA", map);
  map.objects[seen.object_index].front_probability = 0.6;
  WriteOurs("OursB", map);
  WriteOurs("OursC");
  EXPECT_EQ(Run().errors, "");
  const json variants = PageDataIn(Page())["variants"];
  EXPECT_EQ(variants[0]["outlines"][0].at("front"), 0.95);
  for (const int i : {1, 2}) EXPECT_FALSE(variants[i]["outlines"][0].contains("front"));
  const auto object = [&](int i) { return variants[i]["objects"][seen.object_index]; };
  EXPECT_EQ(object(0).at("front"), json({{"probability", 0.95}, {"is_known", true}}));
  EXPECT_EQ(object(1).at("front"), json({{"probability", 0.6}, {"is_known", false}}));
  EXPECT_FALSE(object(2).contains("front"));
}

TEST_F(RunPagesTest, WithoutImagesFramesHaveOutlinesAllTheSame) {
  WriteMultiView("MultiView");
  fs::remove_all(Dataset());
  Run();
  const json page = PageDataIn(Page());
  EXPECT_TRUE(page["images"].empty());
  const json& sequence = page["sequences"][0];
  for (const json& frame : sequence["frames"]) {
    EXPECT_EQ(frame["shown"], true);
    EXPECT_FALSE(frame["grid"].empty());
    EXPECT_EQ(frame["width"], sequence_.camera.width);
  }
  EXPECT_EQ(sequence["detections"].size(), sequence_.detections.size());
  EXPECT_FALSE(page["variants"][0]["outlines"][0]["outline"].empty());
}

// Thousands of objects.
using SlowRunPagesTest = RunPagesTest;

TEST_F(SlowRunPagesTest, LargeDatasetsStayBelowTheLimitAndSaySo) {
  const Camera& camera = sequence_.camera;
  cv::Mat noise(camera.height, camera.width, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 255);
  Write("data/noise.jpg", EncodedImage(".jpg", noise));
  sequence_ = CuboidSequence(4, 60);
  for (Frame& frame : sequence_.frames) frame.image = "noise.jpg";
  const Object object = sequence_.objects.back();
  for (int i = 1; i <= 3000; ++i) {
    sequence_.objects.push_back(object);
    sequence_.objects.back().id += i;
  }
  for (const char* name : {"OursP", "OursPT", "OursS", "OursST"}) WriteOurs(name);
  for (const char* name : {"SVD", "MultiView"}) WriteMultiView(name);
  Run();
  EXPECT_LE(fs::file_size(Page()), kMaxPageBytes);
  EXPECT_GT(fs::file_size(Page()), kMaxPageBytes / 2);
  const json page = PageDataIn(Page());
  EXPECT_EQ(page["variants"].size(), 6u);
  EXPECT_FALSE(page["images"].empty());
  const std::string notes = page["notes"].dump();
  EXPECT_THAT(notes, AllOf(HasSubstr("px wide"), HasSubstr("cost over yaw"),
                           HasSubstr("only the numbers of SVD, MultiView")));
  EXPECT_EQ(PageDataIn(results_.path() / "report.html")["datasets"][0]["notes"], page["notes"]);
}

TEST_F(RunPagesTest, NamesNeedNotBeUtf8) {
  WriteMultiView("Multi\xe9");
  fs::rename(results_.path() / "room", results_.path() / "caf\xe9");
  Run();
  const json overview = PageDataIn(results_.path() / "report.html")["datasets"][0];
  EXPECT_EQ(overview["dataset"], "caf\xef\xbf\xbd");
  EXPECT_EQ(overview["url"], "caf%E9");
  EXPECT_EQ(overview["variants"][0]["name"], "Multi\xef\xbf\xbd");
  EXPECT_TRUE(fs::exists(results_.path() / "caf\xe9/report.html"));
}

TEST_F(RunPagesTest, NamesAreTextWhateverTheyHold) {
  const std::string hostile = "\"'><img src=x onerror=alert(1)>{{scripts}}";
  sequence_.objects[0].label = "</script>" + hostile;
  WriteMultiView(hostile);
  fs::rename(results_.path() / "room", results_.path() / hostile);
  Run();
  for (const fs::path& page :
       {results_.path() / hostile / "report.html", results_.path() / "report.html"}) {
    const std::string html = FileBytes(page);
    EXPECT_THAT(html, HasSubstr("&quot;&#39;&gt;&lt;img src=x onerror=alert(1)&gt;{{scripts}}"));
    EXPECT_THAT(html, HasSubstr("\\u003cimg src=x"));
    EXPECT_THAT(html, testing::Not(HasSubstr("<img")));
  }
}

TEST_F(RunPagesTest, FindingsAreAtTheTopOfPageAndOverview) {
  WriteMultiView("MultiView");
  const Finding finding = {"up", Severity::kError, "looks <down>", "up", "cameras", "turn them"};
  WriteBytes(Folder("MultiView") / "planes.json",
             json{{"findings", DescribedToJson(std::vector{finding})}}.dump());
  Run();
  for (const fs::path& page : {Page(), results_.path() / "report.html"}) {
    const std::string html = FileBytes(page);
    EXPECT_LT(html.find("looks &lt;down&gt;"), html.find("<td>MultiView</td>"));
  }
}

TEST_F(RunPagesTest, NothingToShowAtAllIsAnError) {
  ExpectError<NothingUsableError>([&] { Run(); }, {"no <dataset>/<variant>/"});
  WriteMultiView("MultiView");
  WriteBytes(Folder("MultiView") / "sequence.json", "{}");
  ExpectError<NothingUsableError>([&] { Run(); }, {"no <dataset>/<variant>/"});
  EXPECT_FALSE(fs::exists(results_.path() / "report.html"));
  ExpectError<InputError>(
      [&] {
        RunPages({}, {{"results", Dataset() / "none"}}, 1);
      },
      {"is no folder"});
}

}  // namespace
}  // namespace soslam
