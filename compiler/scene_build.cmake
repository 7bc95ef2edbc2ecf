# Scene data in, GPU tables out: the hierarchy, the lights, the environment. Knows neither glTF nor the package file.
find_package(embree 3.13 REQUIRED)

add_library(lumicut_scene_build STATIC
    ${CMAKE_CURRENT_LIST_DIR}/build_bvh.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bvh_balance.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bvh_collapse.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bvh_moving.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bvh_split.cpp
    ${CMAKE_CURRENT_LIST_DIR}/build_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/caustic_targets.cpp
    ${CMAKE_CURRENT_LIST_DIR}/cube_map.cpp
    ${CMAKE_CURRENT_LIST_DIR}/emission_average.cpp
    ${CMAKE_CURRENT_LIST_DIR}/environment.cpp
    ${CMAKE_CURRENT_LIST_DIR}/environment_map.cpp
    ${CMAKE_CURRENT_LIST_DIR}/environment_sink.cpp
    ${CMAKE_CURRENT_LIST_DIR}/mapped_texture.cpp)
target_link_libraries(lumicut_scene_build PUBLIC lumicut_options lumicut_format fmt::fmt PRIVATE lumicut_image_read embree Threads::Threads)
