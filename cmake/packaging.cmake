# SPDX-License-Identifier: MIT
# What an engine needs of an installation (component "engine"), and the Debian package of all of it.
include(CMakePackageConfigHelpers)

install(TARGETS sluice_api EXPORT SluiceTargets LIBRARY DESTINATION lib COMPONENT engine NAMELINK_COMPONENT engine)
install(FILES ${PROJECT_SOURCE_DIR}/host_gl/include/sluice/sluice.h ${PROJECT_SOURCE_DIR}/interop/include/sluice/plugin.h
    DESTINATION include/sluice COMPONENT engine)
install(EXPORT SluiceTargets NAMESPACE Sluice:: DESTINATION lib/cmake/Sluice COMPONENT engine)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/SluiceConfig.cmake.in ${CMAKE_BINARY_DIR}/SluiceConfig.cmake
    INSTALL_DESTINATION lib/cmake/Sluice)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/SluiceConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/SluiceConfig.cmake ${CMAKE_BINARY_DIR}/SluiceConfigVersion.cmake
    DESTINATION lib/cmake/Sluice COMPONENT engine)
configure_file(${CMAKE_CURRENT_LIST_DIR}/sluice.pc.in ${CMAKE_BINARY_DIR}/sluice.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/sluice.pc DESTINATION lib/pkgconfig COMPONENT engine)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sluice)
set(CPACK_PACKAGE_CONTACT "Sluice <noreply@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Fluid in an OpenGL engine that was never built for it")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip) # a third of the time of xz
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# What is linked is found in the binaries; the loader opens these itself.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libvulkan1")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, libgl1-mesa-dri, libegl-mesa0")
include(CPack)
