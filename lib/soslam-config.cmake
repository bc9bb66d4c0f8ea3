# What find_package(soslam) reads: soslam::core, which needs Eigen and Ceres, and soslam::soslam with the rest, unless
# core is the only component that is asked for.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(Ceres 2.1)
include(${CMAKE_CURRENT_LIST_DIR}/soslam-core-targets.cmake)
if(NOT soslam_FIND_COMPONENTS STREQUAL "core")
  include(${CMAKE_CURRENT_LIST_DIR}/soslam-dependencies.cmake)
  include(${CMAKE_CURRENT_LIST_DIR}/soslam-targets.cmake)
endif()
