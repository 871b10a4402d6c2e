# The plugin of Gazebo 11, for a Debian 11 whose packages are in a folder (scripts/gazebo-root): this
# machine's compiler, with that folder's libraries and headers, those of the C++ standard library too.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(TETHER_GAZEBO_ROOT "${CMAKE_CURRENT_LIST_DIR}/../build/gazebo-root" CACHE PATH
  "Folder with the Debian 11 packages that the plugin is built against")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TETHER_GAZEBO_ROOT)
get_filename_component(CMAKE_SYSROOT "${TETHER_GAZEBO_ROOT}" ABSOLUTE)

set(CMAKE_C_COMPILER gcc)
set(CMAKE_CXX_COMPILER g++)
set(arch x86_64-linux-gnu)
set(headers "${CMAKE_SYSROOT}/usr/include")
string(JOIN " " CMAKE_CXX_FLAGS_INIT -nostdinc++ "-isystem ${headers}/c++/10"
  "-isystem ${headers}/${arch}/c++/10" "-isystem ${headers}/c++/10/backward")
# Before the compiler's own folders, in which this machine's libraries are.
foreach(kind IN ITEMS EXE SHARED MODULE)
  string(JOIN " " CMAKE_${kind}_LINKER_FLAGS_INIT "-L${CMAKE_SYSROOT}/usr/lib/gcc/${arch}/10"
    "-L${CMAKE_SYSROOT}/usr/lib/${arch}" "-L${CMAKE_SYSROOT}/lib/${arch}")
endforeach()

# Programs that help to build are this machine's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_LIBRARY_ARCHITECTURE ${arch})

set(ENV{PKG_CONFIG_SYSROOT_DIR} "${CMAKE_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR} "${CMAKE_SYSROOT}/usr/lib/${arch}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig")
