# Installs the build in BINARY_DIR, then configures, builds and runs the project in consumer/ with
# nothing but what was installed. cmake -DBINARY_DIR=... -DGENERATOR=... -P consumer.cmake
set(folder ${BINARY_DIR}/tests/install)
file(REMOVE_RECURSE ${folder})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${result}:\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${folder}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${folder}/build -G ${GENERATOR}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${folder}/prefix)
run(${CMAKE_COMMAND} --build ${folder}/build)
run(${folder}/build/consumer ${folder}/prefix/share/soslam/pipelines/priors/semantic_table.json)
run(${folder}/prefix/bin/soslam-optimise --version)
