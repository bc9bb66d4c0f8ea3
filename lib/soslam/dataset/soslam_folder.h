// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_files.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/distortion.h"

namespace soslam {

// The parts of ReadSoslamFolder: images with their poses, detections, objects.

// The images of a folder: those of the list, otherwise those that `boxes` name by their timestamps.
// Absolute paths into the folder become relative, ICL-NUIM's frame numbers become seconds. Throws
// InputError naming line or box.
std::vector<ListedImage> ListImages(const std::filesystem::path& folder, const DatasetFiles& files,
                                    const ImportOptions& options,
                                    const std::vector<LabelledBox>& boxes);

// Creates a frame per image with the pose nearest in time or with the same image name, and prints
// to stdout how many have one. EuRoC's poses are those of a body; `body_from_camera` is the
// camera's pose in it, or none if the body is the camera. Only in format soslam the listed image
// files must exist. Suspicious time stamps are added to `findings`. Throws InputError.
std::vector<ListedFrame> ReadFolderFrames(const std::filesystem::path& folder,
                                          const DatasetFiles& files, const ImportOptions& options,
                                          const std::vector<ListedImage>& images,
                                          const std::optional<Rigid3d>& body_from_camera,
                                          std::vector<Finding>* findings);

// Reads the boxes of a folder of images in any of the formats of `detections_format`. Class names
// may be stored with YOLO's labels: `files` then gets their path, which is printed to stdout.
// Throws InputError.
FolderBoxes ReadFolderBoxes(const std::filesystem::path& folder, const ImportOptions& options,
                            const Camera& camera, DatasetFiles* files);

// Converts boxes to rows of these images. Each box without object id is a separate object, with ids
// from `first_free_id` on. Boxes of images that are not listed are counted in `rejected`, and their
// number is printed to stdout. Throws InputError for a row number beyond the list, and when no box
// is of a listed image.
std::vector<DetectionRow> RowsOfBoxes(const std::vector<LabelledBox>& boxes,
                                      const DatasetFiles& files,
                                      const std::vector<ListedImage>& images,
                                      std::int64_t first_free_id, RejectionCounts* rejected);

// Rows of the boxes of listed images, with no object.
std::vector<DetectionRow> RowsWithoutObject(const std::vector<LabelledBox>& boxes,
                                            const std::vector<ListedImage>& images);

// Converts boxes in distorted images to those of a pinhole camera (UndistortBox). Boxes without
// such a counterpart are counted in `rejected`.
std::vector<DetectionRow> Undistorted(std::vector<DetectionRow> rows, const Camera& camera,
                                      const Distortion& distortion, RejectionCounts* rejected);

// Separates boxes without a track, for which trackers may write an id, too: one below 0, or 0 while
// real ids begin at 1. Ids below 0 mean no track; so does 0 if several boxes of one image have it
// in at least two images (one, when no box has another id), as real ids are unique per image. Ids
// listed in objects.json are real.
//
// Returns the boxes with ids. Boxes without a track become `left_out`; their number is printed to
// stdout with the name of the `file`. When no box has an id, all are returned without ids, which is
// a finding.
std::vector<LabelledBox> SeparateUntrackedBoxes(std::vector<LabelledBox> boxes,
                                                const std::vector<ListedObject>& objects,
                                                const std::filesystem::path& file,
                                                std::vector<LabelledBox>* left_out,
                                                std::vector<Finding>* findings);

// True if any box has an object id.
bool HaveObjectIds(const std::vector<LabelledBox>& boxes);

// Gives all rows of an object one label, as detectors use several labels for one object: the most
// frequent one (ties: larger sum of scores, then alphabetical), or that of objects.json unless more
// than half of the rows have another. Returns the number of rows whose label changed. Throws
// InputError, naming a row, for an object whose label in objects.json differs from that of most
// rows.
int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows);

// All objects of a dataset, sorted by id: those of objects.json, detected or not, and those that
// only occur in detections, which have no ground truth. An object stands on its support_plane, or
// else on the only plane. Where there are several, the plane of a row without object id is unknown;
// an object with an id must say its plane. Rows of one object have one label. Throws InputError for
// a plane that does not exist or is not given.
std::vector<Object> ListObjects(const DatasetFiles& files, const std::vector<ListedObject>& given,
                                const std::vector<DetectionRow>& rows,
                                const std::vector<SupportPlane>& planes, bool has_object_ids);

}  // namespace soslam
