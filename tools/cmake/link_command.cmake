# Before cpack packs: /usr/bin/voqcal, the one command outside /opt/voqcal.
file(MAKE_DIRECTORY ${CPACK_TEMPORARY_DIRECTORY}/usr/bin)
file(CREATE_LINK ../../opt/voqcal/tools/voqcal ${CPACK_TEMPORARY_DIRECTORY}/usr/bin/voqcal SYMBOLIC)
