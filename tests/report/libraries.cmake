set(KINFER_TEST_LIBRARIES nlohmann_json::nlohmann_json)
