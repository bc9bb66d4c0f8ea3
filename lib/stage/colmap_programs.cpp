// SPDX-License-Identifier: BSD-3-Clause
#include "stage/colmap_programs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

#include "artefact/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/paths.h"
#include "base/process.h"
#include "base/progress.h"
#include "dataset/colmap_camera.h"
#include "dataset/colmap_model.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Files in a workspace.
constexpr const char* kDatabase = "database.db";
constexpr const char* kImageList = "images.txt";
constexpr const char* kLog = "log.txt";
constexpr const char* kModels = "sparse";

constexpr int kBlockSize = 10;  // images per block of exhaustive matching

// Observations of a point with a larger error are left out. With COLMAP's own bound, 4, enough
// wrong matches remain to bend an estimated focal length by more than 1 %.
constexpr const char* kMaxReprojectionErrorPx = "1.5";

// Last number in a line; 0 without one.
int LastNumber(const std::string& line) {
  const size_t end = line.find_last_of("0123456789");
  if (end == line.npos) return 0;
  const size_t before = line.find_last_not_of("0123456789", end);
  const size_t begin = before == line.npos ? 0 : before + 1;
  return std::atoi(line.substr(begin, std::min<size_t>(end + 1 - begin, 9)).c_str());
}

bool Contains(const std::string& line, const char* text) { return line.find(text) != line.npos; }

std::string FileText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Text that differs for each job that COLMAP may treat differently.
std::string StampOf(const ColmapJob& job, const std::string& version) {
  std::string text = fmt::format("COLMAP {}\nexhaustive {}\nfixed camera {}\n", version,
                                 job.exhaustive, job.camera_is_fixed);
  if (!job.camera_is_fixed) text += fmt::format("at most {} px\n", kMaxReprojectionErrorPx);
  if (job.camera) {
    const ColmapCameraText camera = ToColmap(*job.camera);
    text += fmt::format("{} {}\n", camera.model, camera.parameters);
  }
  for (size_t i = 0; i < job.images.size(); ++i) {
    text += fmt::format("{} {}\n", Sha256OfFile(job.dataset / job.images[i]), job.images[i]);
    if (job.poses.empty() || !job.poses[i]) continue;
    text += fmt::format("  {} {}\n", fmt::join(job.poses[i]->translation, " "),
                        fmt::join(job.poses[i]->rotation.coeffs(), " "));
  }
  return text;
}

// Runs COLMAP's programs one after the other, with a common log.
class Session {
 public:
  explicit Session(const fs::path& workspace) : log_path_(workspace / kLog), log_(log_path_) {}

  // Returns the exit code. `use_line` gets each line that the program prints.
  int Call(const std::vector<std::string>& arguments,
           const std::function<void(const std::string&)>& use_line) {
    std::vector<std::string> words = {"colmap"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    log_ << fmt::format("$ {}\n", fmt::join(words, " ")) << std::flush;
    return FollowProgram(words,
                         [&](const std::string& line) {
                           log_ << line << '\n' << std::flush;
                           const bool is_error =
                               Contains(line, "ERROR") || Contains(line, "Check failed");
                           if (is_error) error_ = line;
                           if (line.find_first_not_of(" \r") != line.npos) last_line_ = line;
                           use_line(line);
                         })
        .value_or(-1);
  }

  // Throws NothingUsableError unless the exit code is 0.
  void Require(const std::vector<std::string>& arguments,
               const std::function<void(const std::string&)>& use_line) {
    const int exit_code = Call(arguments, use_line);
    if (exit_code != 0) Fail(arguments.front(), exit_code);
  }

  [[noreturn]] void Fail(const std::string& program, int exit_code) const {
    throw NothingUsableError(fmt::format("colmap {}: failed with exit code {}: {}; see {}", program,
                                         exit_code, error_.empty() ? last_line_ : error_,
                                         log_path_.string()));
  }

  const fs::path& log_path() const { return log_path_; }

 private:
  fs::path log_path_;
  std::ofstream log_;
  std::string last_line_, error_;
};

// Progress up to a count that lines state.
class Follower {
 public:
  Follower(const std::string& what, int count) : progress_(what, count), count_(count) {}
  void Reach(int done) {
    for (; done_ < std::min(done, count_); ++done_) progress_.Step();
  }
  void Step() { Reach(done_ + 1); }

 private:
  Progress progress_;
  int count_;
  int done_ = 0;
};

// Throws NothingUsableError when features were counted, and no image has one.
void Extract(const ColmapJob& job, const std::vector<std::string>& arguments, Session* session) {
  Follower follower("images: features", static_cast<int>(job.images.size()));
  int counted = 0, with_features = 0;
  session->Require(arguments, [&](const std::string& line) {
    if (Contains(line, "Processed file [")) follower.Step();
    if (Contains(line, "already extracted")) ++with_features;
    if (!Contains(line, "Features:")) return;
    ++counted;
    if (LastNumber(line) > 0) ++with_features;
  });
  if (counted == 0 || with_features > 0) return;
  throw NothingUsableError(fmt::format(
      "{}: none of {} images has features; expected corners and texture: are the images blank, "
      "dark or blurred?",
      job.dataset.string(), job.images.size()));
}

void Match(const ColmapJob& job, const std::vector<std::string>& arguments, Session* session) {
  const int images = static_cast<int>(job.images.size());
  const int blocks = (images + kBlockSize - 1) / kBlockSize;
  Follower follower(job.exhaustive ? "blocks of images matched" : "images matched",
                    job.exhaustive ? blocks * blocks : images);
  session->Require(arguments, [&](const std::string& line) {
    if (Contains(line, "block [") || Contains(line, "image [")) follower.Step();
  });
}

// The model of the given poses, in which COLMAP triangulates points.
void WriteGivenModel(const ColmapJob& job, const fs::path& folder) {
  fs::create_directories(folder);
  const ColmapCameraText camera = ToColmap(*job.camera);
  std::string parameters = camera.parameters, images;
  std::ranges::replace(parameters, ',', ' ');
  for (size_t i = 0; i < job.images.size(); ++i) {
    if (!job.poses[i]) continue;
    const Rigid3d camera_from_world = job.poses[i]->Inverse();
    const Eigen::Quaterniond& q = camera_from_world.rotation;
    images += fmt::format("{} {} {} {} {} {} 1 {}\n\n", i + 1, q.w(), q.x(), q.y(), q.z(),
                          fmt::join(camera_from_world.translation, " "), job.images[i]);
  }
  WriteTextFile(folder / "cameras.txt",
                fmt::format("1 {} {} {} {}\n", camera.model, job.camera->camera.width,
                            job.camera->camera.height, parameters));
  WriteTextFile(folder / "images.txt", images);
  WriteTextFile(folder / "points3D.txt", "");
}

std::vector<std::string> MapperWords(const ColmapJob& job, const fs::path& workspace,
                                     const fs::path& output) {
  const bool poses_are_given = !job.poses.empty();
  std::vector<std::string> words = {poses_are_given ? "point_triangulator" : "mapper",
                                    "--database_path",
                                    (workspace / kDatabase).string(),
                                    "--image_path",
                                    job.dataset.string(),
                                    "--output_path",
                                    output.string(),
                                    "--Mapper.num_threads",
                                    std::to_string(job.threads)};
  if (poses_are_given) {
    WriteGivenModel(job, workspace / "given");
    words.insert(words.end(),
                 {"--input_path", (workspace / "given").string(), "--clear_points", "1"});
  }
  if (!job.camera_is_fixed) {
    words.insert(words.end(), {"--Mapper.filter_max_reproj_error", kMaxReprojectionErrorPx});
    return words;
  }
  // Images whose camera has a larger coefficient of distortion would be left out.
  words.insert(words.end(), {"--Mapper.max_extra_param", "1e6"});
  for (const char* option : {"focal_length", "principal_point", "extra_params"}) {
    words.insert(words.end(), {fmt::format("--Mapper.ba_refine_{}", option), "0"});
  }
  return words;
}

// Throws NothingUsableError for a crash; the mapper also fails where it finds no model.
void Map(const ColmapJob& job, const std::vector<std::string>& words, Session* session) {
  Follower follower("images registered", static_cast<int>(job.images.size()));
  const int exit_code = session->Call(words, [&](const std::string& line) {
    if (Contains(line, "Registering image #")) follower.Reach(LastNumber(line));
    if (Contains(line, "Triangulating image #")) follower.Step();
  });
  if (exit_code != 0 && !job.poses.empty()) {
    throw NothingUsableError(
        fmt::format("{}: colmap point_triangulator failed with exit code {}, as where no point is "
                    "triangulated; expected poses and a camera that fit the images; see {}",
                    job.dataset.string(), exit_code, session->log_path().string()));
  }
  const bool may_have_found_nothing = exit_code == 1;
  if (exit_code != 0 && !may_have_found_nothing) session->Fail(words.front(), exit_code);
}

}  // namespace

std::vector<fs::path> ColmapModelsIn(const fs::path& folder) {
  if (IsColmapModel(folder)) return {folder};
  std::vector<fs::path> models;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (IsColmapModel(entry.path())) models.push_back(entry.path());
  }
  std::ranges::sort(models, {}, [](const fs::path& model) {
    const std::string name = model.filename().string();
    return std::pair(name.size(), name);
  });
  return models;
}

Colmap::Colmap() {
  setenv("QT_QPA_PLATFORM", "offscreen", 0);  // its programs open a display otherwise
  const auto found = FollowProgram({"colmap", "-h"}, [&](const std::string& line) {
    std::smatch match;
    if (version_.empty() && std::regex_search(line, match, std::regex(R"(COLMAP (\d\S*))"))) {
      version_ = match[1];
    }
  });
  if (!found) {
    throw SettingsError(
        "colmap: there is no such program on PATH; expected COLMAP: install the package colmap "
        "(apt-get install colmap), or give a finished model of it (--model FOLDER)");
  }
  extraction_ = "SiftExtraction";
  matching_ = "SiftMatching";
  FollowProgram({"colmap", "feature_extractor", "-h"}, [&](const std::string& line) {
    if (!Contains(line, "--FeatureExtraction.use_gpu")) return;
    extraction_ = "FeatureExtraction";
    matching_ = "FeatureMatching";
  });
}

std::vector<std::string> Colmap::ExtractorWords(const ColmapJob& job,
                                                const fs::path& workspace) const {
  std::vector<std::string> words = {"feature_extractor",
                                    "--database_path",
                                    (workspace / kDatabase).string(),
                                    "--image_path",
                                    job.dataset.string(),
                                    "--image_list_path",
                                    (workspace / kImageList).string(),
                                    "--ImageReader.single_camera",
                                    "1",
                                    fmt::format("--{}.use_gpu", extraction_),
                                    "0",
                                    fmt::format("--{}.num_threads", extraction_),
                                    std::to_string(job.threads),
                                    "--ImageReader.camera_model"};
  if (job.camera) {
    const ColmapCameraText camera = ToColmap(*job.camera);
    words.insert(words.end(), {camera.model, "--ImageReader.camera_params", camera.parameters});
  } else {
    words.emplace_back("SIMPLE_RADIAL");
  }
  return words;
}

std::vector<std::string> Colmap::MatcherWords(const ColmapJob& job,
                                              const fs::path& workspace) const {
  std::vector<std::string> words = {job.exhaustive ? "exhaustive_matcher" : "sequential_matcher",
                                    "--database_path",
                                    (workspace / kDatabase).string(),
                                    fmt::format("--{}.use_gpu", matching_),
                                    "0",
                                    fmt::format("--{}.num_threads", matching_),
                                    std::to_string(job.threads)};
  if (job.exhaustive) {
    words.insert(words.end(), {"--ExhaustiveMatching.block_size", std::to_string(kBlockSize)});
  }
  return words;
}

void Colmap::MakeModels(const ColmapJob& job, const fs::path& workspace) const {
  Session session(workspace);
  Extract(job, ExtractorWords(job, workspace), &session);
  Match(job, MatcherWords(job, workspace), &session);
  const fs::path unfinished = workspace / "sparse.unfinished";
  fs::remove_all(unfinished);
  fs::create_directories(unfinished);
  Map(job, MapperWords(job, workspace, unfinished), &session);
  if (ColmapModelsIn(unfinished).empty()) {
    throw NumericalError(fmt::format(
        "{}: COLMAP found no two images to begin a model with; expected images that overlap, from "
        "places apart: where the camera only turns there is no baseline, and poses have to be "
        "given (--poses given); see {}",
        job.dataset.string(), (workspace / kLog).string()));
  }
  fs::rename(unfinished, workspace / kModels);
}

std::vector<fs::path> Colmap::Run(const ColmapJob& job, const fs::path& workspace) const {
  const fs::path stamp = workspace / "job.txt";
  const std::string wanted = StampOf(job, version_);
  const std::string found = FileText(stamp);
  if (found != wanted) {
    if (IsFolder(workspace) && !fs::is_empty(workspace) && !found.starts_with("COLMAP ")) {
      throw SettingsError(workspace.string() +
                          ": has files that are not of soslam-reconstruct, which would be removed; "
                          "expected another --output, or --model with a model of this folder");
    }
    fs::remove_all(workspace);
    fs::create_directories(workspace);
    WriteTextFile(workspace / kImageList, fmt::format("{}\n", fmt::join(job.images, "\n")));
    WriteTextFile(stamp, wanted);
  }
  if (!IsFolder(workspace / kModels)) MakeModels(job, workspace);
  return ColmapModelsIn(workspace / kModels);
}

}  // namespace soslam
