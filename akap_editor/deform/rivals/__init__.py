"""Other deformation methods under the same contract, for comparison."""
