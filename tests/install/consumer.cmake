# Installs the build in BINARY_DIR, then configures, builds and runs the programs of consumers with nothing but what was
# installed. cmake -DBINARY_DIR=... -DGENERATOR=... -P consumer.cmake
set(folder ${BINARY_DIR}/tests/install)
set(prefix ${folder}/prefix)
get_filename_component(source ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
file(REMOVE_RECURSE ${folder})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# Builds one of them, with a generator and more arguments for its configuration.
function(build consumer generator)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/${consumer} -B ${folder}/${consumer} -G ${generator}
      -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${prefix} ${ARGN})
  run(${CMAKE_COMMAND} --build ${folder}/${consumer})
endfunction()

run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${prefix})

# Nothing that was installed for CMake names a place on this machine.
file(GLOB package_files ${prefix}/lib/*/cmake/soslam/*.cmake ${prefix}/lib/cmake/soslam/*.cmake)
if(NOT package_files)
  message(FATAL_ERROR "nothing was installed for CMake")
endif()
foreach(file ${package_files})
  file(READ ${file} text)
  string(FIND "${text}" "${source}" at)
  if(NOT at EQUAL -1 OR text MATCHES "[;\"]/(usr|home|root|tmp|opt)/")
    message(FATAL_ERROR "${file} has a path of this machine")
  endif()
endforeach()

# The core needs Eigen and Ceres alone: no other package is found, and no other header of the system is read.
set(others OpenCV fmt nlohmann_json HDF5 LibArchive ZLIB yaml-cpp OpenSSL)
list(TRANSFORM others PREPEND -DCMAKE_DISABLE_FIND_PACKAGE_)
list(TRANSFORM others APPEND =ON)
build(core_consumer "Unix Makefiles" ${others})  # Ninja deletes the lists of headers
file(GLOB_RECURSE read_files ${folder}/core_consumer/*.d)
if(NOT read_files)
  message(FATAL_ERROR "there is no list of the headers that make_map.cpp reads")
endif()
foreach(file ${read_files})
  file(STRINGS ${file} headers REGEX "opencv2|/fmt/|nlohmann|hdf5|openssl")
  if(headers)
    message(FATAL_ERROR "soslam::core includes ${headers}")
  endif()
endforeach()
run(${folder}/core_consumer/make_map)

# docs/library.md shows this program, and what it prints.
file(READ ${source}/docs/library.md library)
file(READ ${CMAKE_CURRENT_LIST_DIR}/core_consumer/make_map.cpp program)
string(REGEX REPLACE "^// SPDX[^\n]+" "" program "${program}")  # the licence
string(REGEX REPLACE "\n([^\n])" "\n    \\1" program "${program}")
string(FIND "${library}" "${program}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "docs/library.md does not show tests/install/core_consumer/make_map.cpp as it is")
endif()
string(STRIP "${output}" output)
string(FIND "${library}" "${output}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "docs/library.md does not have what the program prints: ${output}")
endif()

# A map of installed programs, read and evaluated by a program of somebody else.
build(consumer ${GENERATOR})
set(table ${prefix}/share/soslam/pipelines/priors/semantic_table.json)
run(${prefix}/bin/soslam-import --dataset ${source}/data/room_a --output ${folder}/sequence.json)
run(${prefix}/bin/soslam-initialise --sequence ${folder}/sequence.json --table ${table}
    --output ${folder}/initial.json)
run(${prefix}/bin/soslam-optimise --landmarks ${folder}/initial.json --sequence ${folder}/sequence.json
    --table ${table} --output ${folder}/map.json)
run(${folder}/consumer/evaluate_map ${folder}/sequence.json ${folder}/map.json)
