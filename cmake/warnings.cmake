# One interface target that every target of the project links privately: warnings, floating point, sanitizers.
add_library(ricochet_flags INTERFACE)
target_compile_options(ricochet_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wmissing-prototypes -Wstrict-prototypes -ffp-contract=off
  $<$<BOOL:${CMAKE_COMPILE_WARNING_AS_ERROR}>:-Werror>)
if(RICOCHET_SANITIZE_THREADS)
  target_compile_options(ricochet_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(ricochet_flags INTERFACE -fsanitize=thread)
endif()
if(RICOCHET_SANITIZE)
  target_compile_options(ricochet_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  target_link_options(ricochet_flags INTERFACE -fsanitize=address,undefined)
endif()
