# Every package is Debian's; docs/dependencies.md says what each is for.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(TIFF REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(embree CONFIG REQUIRED) # 3 on Debian 12, 4 on Debian 13: render/accel/embree.h absorbs the difference
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp libwebpmux)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(TINYGLTF REQUIRED IMPORTED_TARGET tinygltf)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
# Debian's OpenSubdivConfig.cmake names a static library that the package does not hold.
find_library(OSD_CPU_LIBRARY osdCPU REQUIRED)
find_path(OSD_INCLUDE_DIR opensubdiv/version.h REQUIRED)
add_library(OpenSubdiv::osdCPU SHARED IMPORTED)
set_target_properties(OpenSubdiv::osdCPU PROPERTIES IMPORTED_LOCATION ${OSD_CPU_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${OSD_INCLUDE_DIR})
if(KILN_TESTS)
  pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
endif()
