# The packages of soslam::soslam, for building it and for programs that link it. Libraries without a package file of
# their own become targets here, so that what is installed names no path of the machine that built it.
find_dependency(OpenCV COMPONENTS core imgproc imgcodecs calib3d dnn features2d video)
find_dependency(nlohmann_json 3.10.5)
find_dependency(fmt)
find_dependency(OpenSSL)
find_dependency(LibArchive)
find_dependency(ZLIB)
find_dependency(yaml-cpp)
if(NOT TARGET yaml-cpp::yaml-cpp)  # before 0.8
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()
# HDF5, FFmpeg's, those of ONNX files, and a second backend of detector networks, where its package is there
# (libonnxruntime-dev of Debian 13).
foreach(library hdf5 avformat avcodec swscale avutil onnx_proto protobuf onnxruntime)
  find_library(SOSLAM_${library} NAMES ${library}_serial ${library})  # Debian's HDF5 is hdf5_serial
  if(SOSLAM_${library} AND NOT TARGET soslam_external::${library})
    add_library(soslam_external::${library} UNKNOWN IMPORTED)
    set_target_properties(soslam_external::${library} PROPERTIES IMPORTED_LOCATION ${SOSLAM_${library}})
  elseif(NOT SOSLAM_${library} AND NOT library STREQUAL onnxruntime)
    string(APPEND soslam_MISSING " the library ${library}")
  endif()
endforeach()
