# What `cpack -G DEB` packs (scripts/package, scripts/build-arm64): the parts that install() names as
# components, each as a Debian package.
#
#   tether       tether                 the host: the program, and its data in /usr/share/tether, guides
#   tether-sut   tether-sut             the target: the paper's tasks with missions and rigs, and what supervises
#                                       other programs
#   tether-counter  tether-counter      the plugin of emulators that counts what a program computes
#   client       libtether-client1      the shared library of other people's programs
#   client-dev   libtether-client-dev   what it takes to build them
#   python       python3-tether         the same library, and runs and records, for Python
#   doc          tether-doc             the site of scripts/docs, if it was built before CMake configures

set(components tether-sut)
install(DIRECTORY data/missions data/programs data/rigs DESTINATION "${CMAKE_INSTALL_DATADIR}/tether" COMPONENT tether-sut
  USE_SOURCE_PERMISSIONS)
if(NOT TETHER_TARGET_ONLY)
  list(APPEND components tether tether-counter)
  install(DIRECTORY data/campaigns data/energy data/engines data/models data/profiles data/scenarios data/templates data/worlds
    DESTINATION "${CMAKE_INSTALL_DATADIR}/tether" COMPONENT tether)
  set(site "${PROJECT_SOURCE_DIR}/build/docs/html")
  install(DIRECTORY "${site}" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/tether-doc" COMPONENT doc OPTIONAL)
  if(EXISTS "${site}")
    list(APPEND components doc)
  endif()
endif()
set(package_of_doc tether-doc)
set(package_of_tether tether)
set(package_of_tether-sut tether-sut)
set(package_of_tether-counter tether-counter)
if(TARGET tether-client)
  list(APPEND components client client-dev python)
  set(package_of_client libtether-client1)
  set(package_of_client-dev libtether-client-dev)
  set(package_of_python python3-tether)
endif()

# ---- The documents that every Debian package has -------------------------------------------------

find_program(TETHER_GZIP gzip)
mark_as_advanced(TETHER_GZIP)
execute_process(COMMAND git log -1 --format=%cD WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  OUTPUT_VARIABLE changed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT changed)
  string(TIMESTAMP changed "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
# Who packs it: the author of the last commit, unless -DTETHER_MAINTAINER="NAME <ADDRESS>" names another.
execute_process(COMMAND git log -1 "--format=%an <%ae>" WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  OUTPUT_VARIABLE author OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(TETHER_MAINTAINER "" CACHE STRING "Maintainer of the Debian packages, NAME <ADDRESS> [author of the last commit]")
set(maintainer "${TETHER_MAINTAINER}")
if(NOT maintainer)
  set(maintainer "${author}")
endif()
set(documents "${PROJECT_BINARY_DIR}/package")
configure_file(packaging/changelog.in "${documents}/changelog" @ONLY)
if(TETHER_GZIP)
  execute_process(COMMAND ${TETHER_GZIP} -9nf "${documents}/changelog")
endif()

# Manual pages go with what they are about, packed as Debian has them. What a page in docs/man leaves open, the program
# itself fills in; one for another machine runs in the toolchain's emulator.
if(TETHER_GZIP)
  set(pack COMMAND ${TETHER_GZIP} -9nkf)
  set(packed .gz)
endif()
set(programs tether tether-sut tether-exec)
set(components_of_programs tether tether-sut tether-sut)
set(pages)
foreach(program component IN ZIP_LISTS programs components_of_programs)
  if(TARGET ${program} AND (NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR))
    set(source "${PROJECT_SOURCE_DIR}/docs/man/${program}.1")
    set(page "${PROJECT_BINARY_DIR}/man/${program}.1")
    add_custom_command(OUTPUT "${page}${packed}" DEPENDS "${source}" ${program}
      COMMAND ${program} --manual-page "${source}" > "${page}" ${pack} "${page}")
    list(APPEND pages "${page}${packed}")
    # Who builds some programs only, can install them without their pages.
    install(FILES "${page}${packed}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT ${component} OPTIONAL)
  endif()
endforeach()
add_custom_target(tether_manual_pages ALL DEPENDS ${pages})
if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
  message(WARNING "No qemu-aarch64: the packages get no manual pages of programs")
endif()
set(page docs/man/tether-client.3)
if(TETHER_GZIP)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${page}")
  set(packed "${documents}/tether-client.3.gz")
  execute_process(COMMAND ${TETHER_GZIP} -9nc "${PROJECT_SOURCE_DIR}/${page}" OUTPUT_FILE "${packed}")
  set(page "${packed}")
endif()
install(FILES "${page}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man3" COMPONENT client-dev)

# What shells load when the name of a program is completed for the first time. It asks the program, so that it works
# for programs of other machines too, and always fits the program.
set(completed tether-sut)
if(NOT TETHER_TARGET_ONLY)
  list(APPEND completed tether)
endif()
foreach(program IN LISTS completed)
  foreach(place IN ITEMS "bash:bash-completion/completions/${program}" "zsh:zsh/vendor-completions/_${program}"
      "fish:fish/vendor_completions.d/${program}.fish")
    string(REGEX MATCH "^(.*):(.*)/(.*)$" match "${place}")
    set(folder "${CMAKE_INSTALL_DATADIR}/${CMAKE_MATCH_2}")
    set(file "${documents}/${CMAKE_MATCH_3}")
    configure_file("packaging/completions/${CMAKE_MATCH_1}.in" "${file}.${CMAKE_MATCH_1}" @ONLY)
    install(FILES "${file}.${CMAKE_MATCH_1}" DESTINATION "${folder}" RENAME "${CMAKE_MATCH_3}" COMPONENT ${program})
  endforeach()
endforeach()

foreach(component IN LISTS components)
  set(destination "${CMAKE_INSTALL_DATADIR}/doc/${package_of_${component}}")
  install(FILES packaging/copyright DESTINATION "${destination}" COMPONENT ${component})
  install(FILES "${documents}/changelog.gz" DESTINATION "${destination}" COMPONENT ${component} OPTIONAL)
endforeach()

# The guides, with what they link to. Links out of docs/ lead to where the file is installed.
if(NOT TETHER_TARGET_ONLY)
  set(destination "${CMAKE_INSTALL_DATADIR}/doc/tether")
  file(GLOB guides RELATIVE "${PROJECT_SOURCE_DIR}/docs" CONFIGURE_DEPENDS docs/guide/*.md)
  foreach(guide IN LISTS guides)
    file(READ "docs/${guide}" text)
    foreach(place IN ITEMS
        "data/:/usr/share/tether/"
        "examples/own-sut:/usr/share/doc/libtether-client-dev/examples/own-sut"
        "examples/depth-camera:/usr/share/doc/libtether-client-dev/examples/depth-camera"
        "examples/node-companion:../examples/node-companion"
        "examples/own-simulator:../examples/own-simulator"
        "examples/ros1-face-box:../examples/ros1-face-box"
        "examples/python-face-anchor:/usr/share/doc/python3-tether/examples/python-face-anchor"
        "host/external/sim/protocol/schema/:/usr/share/tether/schema/"
        "target/client/c_api/include/:/usr/include/")
      string(REGEX MATCH "^(.*):(.*)$" match "${place}")
      string(REPLACE "](../../${CMAKE_MATCH_1}" "](${CMAKE_MATCH_2}" text "${text}")
    endforeach()
    file(CONFIGURE OUTPUT "${documents}/${guide}" CONTENT "${text}" @ONLY)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/${guide}")
  endforeach()
  install(DIRECTORY "${documents}/guide" docs/adr docs/images DESTINATION "${destination}" COMPONENT tether)
  file(READ CHANGELOG.md text)
  string(REPLACE "](docs/" "](" text "${text}")
  file(CONFIGURE OUTPUT "${documents}/CHANGELOG.md" CONTENT "${text}" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/CHANGELOG.md")
  install(FILES docs/design.md docs/results.md docs/scale.md "${documents}/CHANGELOG.md"
    DESTINATION "${destination}" COMPONENT tether)
  install(DIRECTORY examples/node-companion examples/ros1-face-box DESTINATION "${destination}/examples" COMPONENT tether
    USE_SOURCE_PERMISSIONS PATTERN node_modules EXCLUDE)
  install(DIRECTORY examples/own-simulator DESTINATION "${destination}/examples" COMPONENT tether
    PATTERN build EXCLUDE)
endif()

# ---- CPack ---------------------------------------------------------------------------------------

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  # The packages in the sysroot know what each library of theirs provides; the host's know nothing of
  # these. A list, so that CPack passes the option on.
  set(SHLIBDEPS_EXECUTABLE dpkg-shlibdeps "--admindir=${CMAKE_SYSROOT}/var/lib/dpkg")
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
    "${CMAKE_SYSROOT}/lib/aarch64-linux-gnu" "${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu")
  file(CONFIGURE OUTPUT "${documents}/cpack.cmake" @ONLY CONTENT [[
set(SHLIBDEPS_EXECUTABLE "@SHLIBDEPS_EXECUTABLE@")
]])
  set(CPACK_PROJECT_CONFIG_FILE "${documents}/cpack.cmake")
endif()

# CPack puts a summary of its own before each description, unless it is this one.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake")

# describe(<component> <section> <summary> <text>...): one argument per line, as dpkg wants it; no ";".
function(describe component section)
  string(TOUPPER "${component}" key)
  list(JOIN ARGN "\n" text)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME "${package_of_${component}}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${text}" PARENT_SCOPE)
endfunction()

describe(tether science
  "test in simulation whether a UAV's computer is fast enough"
  "The host's half of Tether. The software under test runs on the board that it is"
  "meant for, or on a virtual target. This program simulates the UAV, its sensors"
  "and the world, and synchronises simulated time with the computing time of the"
  "board. Scenarios and worlds are in /usr/share/tether, guides in"
  "/usr/share/doc/tether/guide.")
set(CPACK_DEBIAN_TETHER_PACKAGE_RECOMMENDS "tether-sut, gnuplot-nox")
# Cameras in Gazebo draw on it.
set(CPACK_DEBIAN_TETHER_PACKAGE_SUGGESTS "xvfb, tether-counter, python3-opencv")

describe(tether-sut science
  "vision tasks of a UAV, flown in simulation or with real sensors"
  "The target's half of Tether: vision tasks of a UAV as one program, which Tether"
  "flies on a simulated UAV, and which can also read real sensors. The package"
  "also has tether-exec, which starts programs of several threads for Tether.")

describe(tether-counter science
  "plugin of QEMU that counts what a program computes"
  "Tether runs software under test with this plugin under qemu-user, and charges"
  "it what its instructions cost on the machine that it is meant for. Such runs"
  "are the same to the byte on every machine.")
set(CPACK_DEBIAN_TETHER-COUNTER_PACKAGE_DEPENDS "qemu-user")

describe(client libs
  "client library of Tether, for programs of UAVs"
  "A UAV's own program links to this library to be flown by Tether. The library"
  "reads sensors and sends commands, and measures the computing time in between.")

file(WRITE "${documents}/triggers" "activate-noawait ldconfig\n")
file(WRITE "${documents}/shlibs" "libtether-client 1 libtether-client1 (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_CLIENT_PACKAGE_CONTROL_EXTRA "${documents}/triggers" "${documents}/shlibs")

describe(client-dev libdevel
  "client library of Tether, development files"
  "Headers for C and C++17, files for CMake and pkg-config, and examples of"
  "programs that Tether can fly.")
set(CPACK_DEBIAN_CLIENT-DEV_PACKAGE_DEPENDS "libtether-client1 (= ${PROJECT_VERSION})")

describe(python python
  "test in simulation whether a UAV's computer is fast enough, in Python"
  "Programs of UAVs in Python fly in Tether by this package, and read images"
  "without a copy. Notebooks start flights by it, and read results and records.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), libtether-client1 (>= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-numpy, python3-zstandard")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "tether, python3-opencv, python3-pandas, python3-matplotlib")
# Compiled once, and not at each start of a program.
file(WRITE "${documents}/postinst" "#!/bin/sh\nset -e\n[ \"$1\" != configure ] || py3compile -p python3-tether\n")
file(WRITE "${documents}/prerm" "#!/bin/sh\nset -e\npy3clean -p python3-tether\n")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${documents}/postinst" "${documents}/prerm")

describe(doc doc
  "documents of Tether as a site"
  "Guides, results, decisions, and the reference of the client library in C and"
  "C++. The site starts with /usr/share/doc/tether-doc/html/index.html.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)

include(CPack)
