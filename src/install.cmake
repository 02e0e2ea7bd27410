# What an installation has besides the programs; the Debian package (`./dev package`) and the archive (`./dev archive`).
include(GNUInstallDirs)
set(pages ${CMAKE_BINARY_DIR}/pages)

# The programs write their pages themselves, from their tables of arguments and keys.
install(CODE "
  file(MAKE_DIRECTORY \"${pages}\")
  function(page name)
    execute_process(COMMAND \${ARGN} OUTPUT_FILE \"${pages}/\${name}\" COMMAND_ERROR_IS_FATAL ANY)
    if(name MATCHES \"[.][15]$\")
      execute_process(COMMAND gzip -9nf \"${pages}/\${name}\" COMMAND_ERROR_IS_FATAL ANY)
    endif()
  endfunction()
  set(palpate \"$<TARGET_FILE:palpate>\")
  page(palpate.1 \${palpate} manual commands --man)
  page(palpate-scenario.5 \${palpate} manual keys --man)
  page(palpate-emulator.1 \"$<TARGET_FILE:palpate-emulator>\" --man)
  page(palpate \${palpate} completion bash)
  page(_palpate \${palpate} completion zsh)
  page(palpate.fish \${palpate} completion fish)
  page(palpate.schema.json \${palpate} schema)
  # Debian's zsh looks for a package's functions elsewhere than for those of /usr/local.
  if(CMAKE_INSTALL_PREFIX MATCHES \"/usr$\")
    set(zsh_functions vendor-completions)
  else()
    set(zsh_functions site-functions)
  endif()
  file(INSTALL \"${pages}/_palpate\" DESTINATION
       \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${zsh_functions}\")
  file(READ \"${PROJECT_SOURCE_DIR}/LICENSE\" licence)
  string(REGEX REPLACE \"\\n\\n\" \"\\n.\\n\" licence \"\${licence}\")
  string(REGEX REPLACE \"\\n\\n\" \"\\n.\\n\" licence \"\${licence}\")
  string(REGEX REPLACE \"\\n\" \"\\n \" licence \"\${licence}\")
  file(WRITE \"${pages}/copyright\"
       \"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\\n\\n\"
       \"Files: *\\nCopyright: The palpate developers\\nLicense: AGPL-3.0-or-later\\n \${licence}\\n\")
")
install(FILES ${pages}/palpate.1.gz ${pages}/palpate-emulator.1.gz
        DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${pages}/palpate-scenario.5.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man5)
install(FILES ${pages}/palpate DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${pages}/palpate.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${pages}/palpate.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate)
install(FILES ${pages}/copyright CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY scenarios materials DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate
        FILES_MATCHING PATTERN "*.toml")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME palpate)
set(CPACK_PACKAGE_VENDOR "The palpate developers")
set(CPACK_PACKAGE_CONTACT "The palpate developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mechanical tests on virtual soft tissue")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Runs presses, creep and relaxation of soft tissue from scenario files: closed forms,
exact layers or meshes of springs, whichever is cheapest and accurate enough, with its
error. Fits curves, runs sweeps, estimates tissue properties, and works with test stands
and haptic arms.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_FILE_NAME palpate-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/archive.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, xdg-utils")
include(CPack)
