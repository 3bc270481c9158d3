# libkiln.so: all modules behind the public headers.
add_library(kiln_shared SHARED)
set_target_properties(kiln_shared PROPERTIES OUTPUT_NAME kiln VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR} LINKER_LANGUAGE CXX)
set(kiln_modules kiln_job kiln_gltf kiln_subdiv kiln_importers kiln_render kiln_color kiln_scene kiln_image kiln_base)
foreach(module ${kiln_modules})
  target_link_libraries(kiln_shared PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,${module}>)
endforeach()
target_include_directories(kiln_shared INTERFACE ${CMAKE_SOURCE_DIR}/include)

include(GNUInstallDirs)
install(TARGETS kiln_shared kiln_program)
install(DIRECTORY include/kiln TYPE INCLUDE)
configure_file(cmake/kiln.pc.in kiln.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
