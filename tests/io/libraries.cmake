# SPDX-License-Identifier: Apache-2.0
# The readers as the fuzzers call them, to replay the corpus.
add_library(fuzzed_readers STATIC ${PROJECT_SOURCE_DIR}/fuzz/readers.cpp)
target_include_directories(fuzzed_readers PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(fuzzed_readers PRIVATE kinfer kinfer_flags nlohmann_json::nlohmann_json)
set(KINFER_TEST_LIBRARIES nlohmann_json::nlohmann_json fuzzed_readers)
