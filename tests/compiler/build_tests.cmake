add_executable(build_test ${CMAKE_CURRENT_LIST_DIR}/build_bvh_test.cpp ${CMAKE_CURRENT_LIST_DIR}/build_lights_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/environment_map_test.cpp ${CMAKE_CURRENT_LIST_DIR}/environment_test.cpp)
target_link_libraries(build_test PRIVATE lumicut_scene_build lumicut_image_read lumicut_test_pictures GTest::gtest_main)
target_compile_definitions(build_test PRIVATE LUMICUT_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared")
gtest_discover_tests(build_test DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
