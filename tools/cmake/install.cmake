# cmake --install, and cpack -G DEB: everything under one folder of its own, in the shape of the source
# tree, so that the same scripts run in both. Programs are installed by voqcal_program().
if(CMAKE_INSTALL_PREFIX_INITIALIZED_TO_DEFAULT)
  set(CMAKE_INSTALL_PREFIX /opt/voqcal CACHE PATH "Where cmake --install puts voqcal" FORCE)
endif()

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # the target programs is enough

file(GLOB launch_scripts RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS modules/*/launch)
foreach(script modules/launch_module ${launch_scripts})
  get_filename_component(folder ${script} DIRECTORY)
  install(PROGRAMS ${script} DESTINATION ${folder})
endforeach()
install(FILES modules/names.txt DESTINATION modules)
install(PROGRAMS tools/up tools/status tools/down tools/run_rig tools/record tools/spy tools/isolated
                 tools/import_ros tools/export_mcap tools/voqcal
  DESTINATION tools)
install(DIRECTORY tools/common/ DESTINATION tools/common FILES_MATCHING PATTERN *.sh)
install(FILES tools/common/stop_session.py DESTINATION tools/common)
# Node.js fetches its libraries there: npm ci.
install(DIRECTORY tools/node DESTINATION tools USE_SOURCE_PERMISSIONS
  PATTERN node_modules EXCLUDE PATTERN test EXCLUDE)
install(DIRECTORY tools/report DESTINATION tools USE_SOURCE_PERMISSIONS
  FILES_MATCHING PATTERN *.py PATTERN *.css PATTERN *.j2)
install(PROGRAMS tools/study/plot_study.py DESTINATION tools/study)
install(DIRECTORY config/rigs DESTINATION config)
install(DIRECTORY lcmtypes/ DESTINATION lcmtypes FILES_MATCHING PATTERN *.lcm)
install(DIRECTORY ${PROJECT_BINARY_DIR}/lcmtypes/cpp/voqcal DESTINATION include)
# For lcm-spy; not there without a JDK.
install(DIRECTORY ${PROJECT_BINARY_DIR}/lib DESTINATION . FILES_MATCHING PATTERN *.jar)
install(FILES README.md DESTINATION .)
install(FILES tools/symptoms.md tools/live.md DESTINATION tools)
install(FILES tools/figures/numbers.md DESTINATION tools/figures)
install(FILES modules/README.md DESTINATION modules)
install(FILES modules/lidar_driver/README.md DESTINATION modules/lidar_driver)
install(FILES modules/extrinsic_monitor/README.md DESTINATION modules/extrinsic_monitor)
install(FILES modules/rig_calibrator/README.md DESTINATION modules/rig_calibrator)
install(DIRECTORY tools/pictures DESTINATION tools
  FILES_MATCHING PATTERN *.svg PATTERN *.jpg PATTERN *.png)

set(CPACK_PACKAGE_NAME voqcal)
set(CPACK_PACKAGE_CONTACT "the voqcal developers <voqcal@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Extrinsic calibration of a camera against a lidar, over LCM")
set(CPACK_PACKAGING_INSTALL_PREFIX /opt/voqcal)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # the libraries, by dpkg-shlibdeps
set(CPACK_DEBIAN_PACKAGE_DEPENDS "liblcm-bin, supervisor, iproute2, python3, python3-jinja2")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "liblcm-java, libjchart2d-java, default-jre, python3-matplotlib, nodejs, npm, qrencode, zstd")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/tools/cmake/link_command.cmake)
include(CPack)
