# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Stands in for rosidl_default_generators where the set-up builds messages for ROS from wheels. What
# loads them there is rclpy over rmw_fastrtps_cpp, which takes messages by the type support of
# Fast DDS for C, and describes them to others by that of introspection for C. The generators of C++
# take half of the time, and come with WITH_CPP. A `colcon build` and the set-up under a sourced ROS
# do not come here: they build everything.

set(rosidl_default_generators_DIR
  "${CMAKE_INSTALL_PREFIX}/share/rosidl_default_generators/cmake")
include("${rosidl_default_generators_DIR}/rosidl_default_generatorsConfig.cmake")

if(NOT WITH_CPP)
  list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "_cpp:")
endif()

# Each generated source reads the same large headers: in a few pieces they are read a few times.
# The descriptions cannot be joined, because they repeat the names of what they refer to, nor can
# the type supports for C++, which specialize templates that others of them have used.
function(join_generated_sources)
  get_target_property(sources ${PROJECT_NAME}__rosidl_generator_c SOURCES)
  list(FILTER sources INCLUDE REGEX "__description\\.c$")
  set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(part generator_c generator_py typesupport_c typesupport_fastrtps_c
      typesupport_introspection_c)
    set_target_properties(${PROJECT_NAME}__rosidl_${part} PROPERTIES
      UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endforeach()
endfunction()
cmake_language(DEFER CALL join_generated_sources)
