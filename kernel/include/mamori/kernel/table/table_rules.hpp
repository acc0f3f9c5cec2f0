// SPDX-License-Identifier: Apache-2.0
/// @file
/// The rules of a system table, each stated once. Compiler messages, the findings of tools and
/// docs/manual/table_rules.md are made from this list.
///
/// @satisfies SWR-KRN-018, SWR-MOD-003, SWR-TAB-015      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TABLE_RULES_HPP
#define MAMORI_KERNEL_TABLE_RULES_HPP

/// X(name, Message, Faulty, sentence) for each rule, in the order of Rule:
///   name      the enumerator without its k, as tools spell it
///   Message   the template that a compiler message shows, with the faulty element as its arguments
///   Faulty    what `Finding::element` counts (`other` in brackets):
///             Row               row of the kind that the rule names
///             Ends              connection, which messages show by its ports and its row
///             Window            window (the window of the same name)
///             TwoWindows        window (the window listed before it)
///             Component         component, by its second row where it has two (its first row; a rule of
///             names:
///                               the component of the same name, or itself without a name)
///             Input             port row of an input
///             Sink              connection, which messages show by its input (the connection listed before)
///             UnlistedPort      component (number of its ports that are constructed after the port)
///             UnlistedParameter component (number of its parameters that are constructed after the one)
///             Port              port row (a rule of names: the row of the same name, or itself without one)
///             Parameter         parameter row (as for a port)
///             ModelledTime      row of a modelled time (the earlier row)
///             Fault             fault (its earlier declaration)
///             FaultInMode       fault (mode; 0 in a table without modes)
///             Mode              mode; the first one where no mode is faulty
///             ModeMember        row of a component of a mode
///             ModeSet           mode with a configuration set
///             InputInMode       port row (mode)
///             ConnectionMode    row of a mode of a connection
///             Transition        transition
///             TransitionEvent   transition (the transition listed before)
///             TransitionTarget  transition
///             ComponentInMode   component (mode)
///             SetAssignment     configuration set (assignment)
///   sentence  the rule
#define MAMORI_TABLE_RULES(X)                                                                             \
    X(FrameNotPositive, FrameIsPositive, Row, "a frame has a positive length")                            \
    X(WindowRowInvalid, WindowRowIsValid, Row,                                                            \
      "a window has a name, a positive period and components, 1 .. 65535 events per cycle, a trigger "    \
      "exactly when it is triggered, slower rates only when it is periodic, an executive of its class, "  \
      "and the rows that name it")                                                                        \
    X(ComponentRowInvalid, WorstCaseIsNotNegative, Component,                                             \
      "the declared worst case of a component is not negative; its row has its window, ports and "        \
      "connections")                                                                                      \
    X(PortRowInvalid, PortRowIsValid, Row,                                                                \
      "a port row has either an input or an output, and the component and the window that have it")       \
    X(ConnectionRowInvalid, ConnectionRowIsValid, Row,                                                    \
      "a connection has two ends, operations with the Crossing that they use, and the windows and "       \
      "components of its ends")                                                                           \
    X(WindowNamedTwice, WindowHasANameOfItsOwn, Window, "each window has a name of its own")              \
    X(TriggerUsedTwice, TriggerServesOneWindow, TwoWindows, "an ExternalTrigger releases one window")     \
    X(PeriodNotInFrame, PeriodDividesFrame, Window, "the period of a window divides the frame")           \
    X(WindowOutsideFrame, WindowIsInsideItsPeriod, Window,                                                \
      "a window starts and ends within its period, at most the frame")                                    \
    X(WindowsOverlap, WindowsAreDisjoint, TwoWindows,                                                     \
      "windows of one core never overlap, except a background window and an ordinary window")             \
    X(BudgetExceedsWindow, BudgetIsInsideWindow, Window,                                                  \
      "the budget of a window is positive and not longer than the window")                                \
    X(BackgroundTooSlow, BackgroundWindowCanComplete, Window,                                             \
      "the budget of a background window, the budgets of the windows that preempt it meanwhile and the "  \
      "publication margin end within its length plus the margin")                                         \
    X(StackOutOfRange, StackIsInRange, Window,                                                            \
      "the stack of a window is a multiple of 1 KiB, from 1 KiB to 65534 KiB")                            \
    X(WorstCasesExceedBudget, WorstCasesFitBudget, Window,                                                \
      "the declared worst cases of a window together fit into its budget")                                \
    X(RateNotOccurrences, RateEqualsOccurrences, Window,                                                  \
      "the declared rate of a window is that of its window starts")                                       \
    X(RateNotReachable, AlternativeRateDividesRate, Window,                                               \
      "a slower rate is reached by skipping window starts, so it divides the first rate")                 \
    X(ComponentInTwoPlaces, ComponentRunsInOneContext, Component, "a component runs in one window, once") \
    X(ComponentNamedTwice, ComponentHasANameOfItsOwn, Component, "each component has a name of its own")  \
    X(PortNotListed, PortIsListed, UnlistedPort,                                                          \
      "the public alias Ports of a component lists each port that is constructed with it")                \
    X(PortNotOwned, PortIsOwned, Port,                                                                    \
      "a listed port is constructed with its component as owner: {*this, ...}")                           \
    X(PortNamedTwice, PortHasANameOfItsOwn, Port,                                                         \
      "each port of a component has a name of its own and is listed once")                                \
    X(ParameterNotListed, ParameterIsListed, UnlistedParameter,                                           \
      "the public alias Parameters of a component lists each parameter that is constructed with it")      \
    X(ParameterNotOwned, ParameterIsOwned, Parameter,                                                     \
      "a listed parameter is constructed with its component as owner: {*this, ...}")                      \
    X(ParameterNamedTwice, ParameterHasANameOfItsOwn, Parameter,                                          \
      "each parameter of a component has a name of its own and is listed once")                           \
    X(PortOfUnknownComponent, ConnectionJoinsComponentsOfTheTable, Ends,                                  \
      "both ends of a connection belong to components that a window runs")                                \
    X(InputNotConnected, InputIsConnected, Input, "a mandatory input is connected")                       \
    X(InputHasTwoWriters, InputHasOneWriter, Input, "an input has one writer")                            \
    X(AgeLimitNotPositive, InputCanBeFresh, Sink,                                                         \
      "a connection states how old a fresh value may be: fresh_within(...), more than 0, or any_age()")   \
    X(AgeLimitCannotBeMet, AgeLimitCanBeMet, Sink,                                                        \
      "fresh_within(...) is not shorter than the minimum age of the value at a start of its reader's "    \
      "window")                                                                                           \
    X(DelayNotStated, ConnectionStatesItsDelay, Sink,                                                     \
      "a connection states delayed_by_a_frame() if its reader does not run after its writer in the same " \
      "window, and only then")                                                                            \
    X(CrossingWithoutBuffer, InputFromElsewhereHasACrossing, Sink,                                        \
      "a connection between cores or partitions goes through(...) a Crossing, or to a queue")             \
    X(CrossingUsedTwice, InputHasACrossingOfItsOwn, Sink, "a Crossing serves one connection")             \
    X(HistoryTooShort, ReaderStartsBeforeValueIsOverwritten, Sink,                                        \
      "a reader on another core or of another class starts, with its delay by preemption and the "        \
      "publication margin, before the second window start of its writer after the publication")           \
    X(MarginNotKept, ReaderStartsAfterPublicationMargin, Sink,                                            \
      "a reader on another core starts at least publication_margin(...) after the end of its writer's "   \
      "window; the margin is not negative")                                                               \
    X(FaultDeclaredTwice, FaultIsDeclaredOnce, Fault, "a fault is declared once")                         \
    X(FaultWithoutReaction, FaultHasReaction, FaultInMode,                                                \
      "a declared fault has a reaction in each mode: react(fault, ...)")                                  \
    X(FaultWithTwoReactions, FaultHasOneReaction, FaultInMode,                                            \
      "a declared fault has at most one reaction in each mode")                                           \
    X(ReactionInUnknownMode, ReactionHasKnownModes, Row, "in_modes<...>() names modes of the table")      \
    X(ReactionWithoutTime, ReactionHasATime, Row, "a reaction has a positive time: within(...)")          \
    X(ReactionToUnknownFault, ReactionAnswersADeclaredFault, Row, "a reaction answers a declared fault")  \
    X(ParameterRowInvalid, ParameterRowIsValid, Row,                                                      \
      "a parameter row has a parameter, its component and the window of that component")                  \
    X(SetRowInvalid, SetRowIsValid, Row,                                                                  \
      "a configuration set has a name, and each of its assignments a parameter and a value for each "     \
      "element")                                                                                          \
    X(ConfigurationRefused, ConfigurationKeeps, SetAssignment,                                            \
      "a configuration set has a name of its own and gives each of its parameters one admitted value")    \
    X(ModelledTimeNegative, ModelledTimeIsNotNegative, ModelledTime, "a modelled time is not negative")   \
    X(ModelledTimeOfUnknownComponent, ModelledTimeHasAComponentOfTheTable, ModelledTime,                  \
      "a modelled time is that of a component that a window runs")                                        \
    X(ModelledTimeStatedTwice, ModelledTimeIsStatedOnce, ModelledTime,                                    \
      "the modelled time of a component is stated once")                                                  \
    X(ActionBudgetOutOfRange, ActionBudgetIsInRange, Row,                                                 \
      "the budget of an action outside windows is positive and at most one hour")                         \
    X(ModeRowInvalid, ModeRowIsValid, Row, "a mode has a name and is one of the first 32")                \
    X(ModeNamedTwice, ModeHasANameOfItsOwn, Mode, "each mode has a name of its own")                      \
    X(ModeOfUnknownComponent, ModeRunsComponentsOfTheTable, ModeMember,                                   \
      "a mode runs components that a window runs")                                                        \
    X(ModeOfUnknownSet, ModeHasAKnownConfigurationSet, ModeSet,                                           \
      "the parameters of a mode are a configuration_set of the table")                                    \
    X(ComponentInNoMode, ComponentRunsInSomeMode, Component, "each component runs in at least one mode")  \
    X(InputNotFedInMode, InputIsFedInEachModeOfItsComponent, InputInMode,                                 \
      "in each mode that runs its component, a mandatory input is fed by a component that runs")          \
    X(ConnectionOfUnknownMode, ConnectionHoldsInKnownModes, ConnectionMode,                               \
      "only_in(...) names modes of the table")                                                            \
    X(TransitionOfUnknownMode, TransitionJoinsKnownModes, Transition,                                     \
      "a transition leads from a mode of the table to a mode of the table")                               \
    X(TransitionAmbiguous, EventLeadsToOneMode, TransitionEvent,                                          \
      "an event has at most one transition in each mode")                                                 \
    X(ModeUnreachable, ModeIsReachable, Mode, "transitions lead from the first mode to each other mode")  \
    X(NoSafeMode, SystemHasASafeMode, Mode, "a system with modes has a safe_mode(...)")                   \
    X(TwoSafeModes, SystemHasOneSafeMode, Mode, "a system has one safe_mode(...)")                        \
    X(SafeModeIsLeft, SafeModeIsLeftByResetOnly, TransitionTarget, "no transition leaves the safe mode")  \
    X(SafeModeActivates, SafeModeActivatesNobody, ComponentInMode,                                        \
      "each component of the safe mode runs in every mode")

#endif  // MAMORI_KERNEL_TABLE_RULES_HPP
