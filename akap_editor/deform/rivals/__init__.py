"""Deformation methods of other papers under the same contract, for comparison."""
