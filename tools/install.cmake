# What `cmake --install` puts where: programs, their manual pages and completions, documents, the licence.
include(GNUInstallDirs)
set(programs lumicut-bench lumicut-compare lumicut-compile lumicut-pkg lumicut-play lumicut-scenes)
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Each program writes its own, so that they are as its command line is.
set(folder ${PROJECT_BINARY_DIR}/documentation)
set(documentation "")
foreach(program IN LISTS programs)
    set(manual ${folder}/${program}.1)
    set(bash ${folder}/bash/${program})
    set(zsh ${folder}/zsh/_${program})
    set(fish ${folder}/fish/${program}.fish)
    add_custom_command(OUTPUT ${manual} ${bash} ${zsh} ${fish}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}/bash ${folder}/zsh ${folder}/fish
        COMMAND $<TARGET_FILE:${program}> --manual > ${manual}
        COMMAND $<TARGET_FILE:${program}> --completion bash > ${bash}
        COMMAND $<TARGET_FILE:${program}> --completion zsh > ${zsh}
        COMMAND $<TARGET_FILE:${program}> --completion fish > ${fish}
        DEPENDS ${program} VERBATIM)
    list(APPEND documentation ${manual} ${bash} ${zsh} ${fish})
    install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${fish} DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endforeach()
add_custom_target(documentation ALL DEPENDS ${documentation})

install(FILES LICENSE README.md CHANGELOG.md format/FORMAT.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.json")
