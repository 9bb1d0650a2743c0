# Finds LCM as Debian packages it (tried on liblcm-dev 1.3.1), which ships no lcmConfig.cmake.
#   LCM::lcm           the library
#   LCM_GEN_EXECUTABLE lcm-gen
#   LCM_JAR            lcm.jar, or LCM_JAR-NOTFOUND
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
find_library(LCM_LIBRARY lcm)
find_program(LCM_GEN_EXECUTABLE lcm-gen)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java)
if(LCM_INCLUDE_DIR AND EXISTS ${LCM_INCLUDE_DIR}/lcm/lcm.h)
  file(STRINGS ${LCM_INCLUDE_DIR}/lcm/lcm.h version_lines REGEX "#define LCM_(MAJOR|MINOR|MICRO)_VERSION")
  string(REGEX REPLACE "[^0-9;]" "" version_numbers "${version_lines}")
  list(JOIN version_numbers "." LCM_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM
  REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN_EXECUTABLE
  VERSION_VAR LCM_VERSION)
if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES
    IMPORTED_LOCATION ${LCM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()
