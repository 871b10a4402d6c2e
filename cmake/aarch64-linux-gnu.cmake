# Programs for 64-bit ARM boards with Debian 12 or Raspberry Pi OS 12, by Debian's cross compiler and a
# sysroot of Debian's arm64 packages (scripts/build-arm64 makes both available).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(TETHER_SYSROOT "${CMAKE_CURRENT_LIST_DIR}/../build/sysroot-arm64" CACHE PATH
  "Folder with the arm64 packages that the target's programs are built against")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TETHER_SYSROOT)
get_filename_component(CMAKE_SYSROOT "${TETHER_SYSROOT}" ABSOLUTE)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

# Runs the programs that print their manual pages; without it, packages have none of them.
find_program(TETHER_QEMU qemu-aarch64)
if(TETHER_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR "${TETHER_QEMU}" -L "${CMAKE_SYSROOT}")
endif()

# Programs that help to build are the host's; all that ends up in the product is from the sysroot.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Debian's way of having libraries of several architectures side by side.
set(CMAKE_INSTALL_LIBDIR lib/aarch64-linux-gnu CACHE PATH "Where libraries go, below the prefix")
