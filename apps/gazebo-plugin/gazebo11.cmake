# Gazebo 11 as target `gazebo11`: what a plugin in gzserver uses of it, and of what it brings.
find_package(PkgConfig REQUIRED)
pkg_check_modules(TETHER_GAZEBO REQUIRED "gazebo >= 11" "gazebo < 12")
add_library(gazebo11 INTERFACE)

# OGRE 1.9 names a type that C++20 has no more. A copy of its headers has the type itself there.
find_path(TETHER_OGRE_INCLUDE_DIR OgreMemorySTLAllocator.h PATH_SUFFIXES OGRE REQUIRED)
mark_as_advanced(TETHER_OGRE_INCLUDE_DIR)
set(ogre "${CMAKE_CURRENT_BINARY_DIR}/ogre")
if(NOT EXISTS "${ogre}/OGRE/OgreMemorySTLAllocator.h")
  file(COPY "${TETHER_OGRE_INCLUDE_DIR}/" DESTINATION "${ogre}/OGRE")
  file(READ "${ogre}/OGRE/OgreMemorySTLAllocator.h" header)
  string(REPLACE "typename std::allocator<void>::const_pointer" "const void*" header "${header}")
  file(WRITE "${ogre}/OGRE/OgreMemorySTLAllocator.h" "${header}")
endif()
target_include_directories(gazebo11 SYSTEM INTERFACE
  "${ogre}" "${ogre}/OGRE" "${ogre}/OGRE/Paging" "${ogre}/OGRE/Terrain")

# The compiler's own folders, named a second time, would come in the wrong order.
set(folders ${TETHER_GAZEBO_INCLUDE_DIRS})
list(FILTER folders EXCLUDE REGEX "/usr/include(/[a-z0-9_]+-linux-gnu)?/?$|krb5")
target_include_directories(gazebo11 SYSTEM INTERFACE ${folders})

# Of Gazebo's many libraries, those that the plugin itself calls.
set(libraries ${TETHER_GAZEBO_LIBRARIES})
list(FILTER libraries INCLUDE REGEX "^(sdformat|ignition-math|protobuf)")
list(APPEND libraries gazebo_physics gazebo_rendering gazebo_transport gazebo_msgs gazebo_common
  gazebo_ode OgreMain GL boost_system)
foreach(library IN LISTS libraries)
  find_library(TETHER_LIBRARY_${library} ${library} HINTS ${TETHER_GAZEBO_LIBRARY_DIRS} REQUIRED)
  mark_as_advanced(TETHER_LIBRARY_${library})
  target_link_libraries(gazebo11 INTERFACE "${TETHER_LIBRARY_${library}}")
endforeach()
