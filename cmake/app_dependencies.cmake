# What the application needs beyond the library; included at the top so that the tests see the imported targets, too.
find_package(MPI REQUIRED COMPONENTS C)
find_package(HDF5 1.10.5 REQUIRED COMPONENTS C HL) # serial or parallel: ranks write without it
find_package(PkgConfig REQUIRED)
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-0.1)
