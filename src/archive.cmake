# Completes the archive (`./dev archive`, CPack's TGZ) beside the installed programs: the libraries that they need,
# but those of C and C++ themselves, in lib/palpate, where the programs look first; and the licences of these.
if(NOT CPACK_GENERATOR STREQUAL "TGZ")
  return()
endif()
cmake_policy(VERSION 3.25)
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY})
set(notes ${root}/share/doc/palpate/libraries)

file(GET_RUNTIME_DEPENDENCIES
     EXECUTABLES ${root}/bin/palpate ${root}/bin/palpate-emulator
     RESOLVED_DEPENDENCIES_VAR libraries
     PRE_EXCLUDE_REGEXES "^(ld-linux.*|lib(c|m|pthread|dl|rt|stdc[+][+]|gcc_s))[.]so")
file(MAKE_DIRECTORY ${root}/lib/palpate ${notes})
foreach(library IN LISTS libraries)
  get_filename_component(name ${library} NAME)
  file(REAL_PATH ${library} file)  # by way of /etc/alternatives
  file(COPY_FILE ${file} ${root}/lib/palpate/${name})
  get_filename_component(path_end ${file} NAME)
  execute_process(COMMAND dpkg-query --search */${path_end} OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "[,:].*" "" package "${found}")
  file(COPY_FILE /usr/share/doc/${package}/copyright ${notes}/${package}.copyright)
  execute_process(COMMAND dpkg-query --show --showformat "\${source:Package} \${source:Version}" ${package}
                  OUTPUT_VARIABLE source COMMAND_ERROR_IS_FATAL ANY)
  file(APPEND ${notes}/sources "${name}: Debian's ${source}\n")
endforeach()
