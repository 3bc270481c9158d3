# libkiln.so: all modules behind the public headers.
set(kiln_modules kiln_job kiln_importers kiln_gltf kiln_subdiv kiln_mesh kiln_render kiln_color kiln_scene kiln_image
  kiln_base)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/kiln_shared.c CONTENT "typedef int kiln_shared; /* CMake wants a source */\n")
add_library(kiln_shared SHARED ${CMAKE_BINARY_DIR}/kiln_shared.c)
set_target_properties(kiln_shared PROPERTIES OUTPUT_NAME kiln VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR} LINKER_LANGUAGE CXX)
target_link_libraries(kiln_shared PRIVATE ${kiln_modules})
list(JOIN kiln_modules "," kiln_whole)
set_target_properties(kiln_shared PROPERTIES LINK_LIBRARY_OVERRIDE "WHOLE_ARCHIVE,${kiln_whole}")
# The standard library's templates come with default visibility, whatever the compiler's flags say.
target_link_options(kiln_shared PRIVATE LINKER:--version-script=${CMAKE_CURRENT_LIST_DIR}/kiln.map)
if(NOT KILN_SANITIZE) # whose symbols come with the program
  target_link_options(kiln_shared PRIVATE LINKER:--no-undefined)
endif()
set_target_properties(kiln_shared PROPERTIES LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/kiln.map)
target_include_directories(kiln_shared INTERFACE ${CMAKE_SOURCE_DIR}/include)

include(GNUInstallDirs)
install(TARGETS kiln_shared kiln_program)
install(DIRECTORY include/kiln TYPE INCLUDE)
# Found from where the file itself is, so that `cmake --install --prefix` is free to choose.
file(RELATIVE_PATH kiln_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/kiln.pc.in kiln.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
